/// Where a value lies among the rows of its edges, and the way through the row, 2^32 for the whole of it.
fn spot_of(position: u32, rows: u32) -> [u32; 2] {
    let product = u64::from(position) * u64::from(rows);
    [(product >> 32) as u32, product as u32]
}

fn spot_geometric(x: f32, offset: f32, sides: &[[u32; 4]; 2]) -> [u32; 2] {
    let [origin, last, rows, _] = sides[(x.to_bits() >> 31) as usize];
    spot_of((x.abs() + offset).to_bits().wrapping_sub(origin).min(last), rows)
}

fn spot_uniform(x: f32, low: f32, scale: f32, rows: u32) -> [u32; 2] {
    spot_of(((x - low) * scale) as u32, rows)
}

/// The high word of a product.
fn high(a: i32, b: i32) -> i32 {
    ((i64::from(a) * i64::from(b)) >> 32) as i32
}

/// Edges from a spot on, each a cubic of the way, onto the sums in which they end.
fn add_edges(sums: &mut [u32], [row, way]: [u32; 2], first: usize, edges: &[[i32; 4]]) {
    let x = (way >> 1) as i32;
    let spot = edges.iter().skip(first + row as usize * sums.len());
    for (sum, [a, b, c, d]) in sums.iter_mut().zip(spot) {
        let edge = a.wrapping_add(high(b.wrapping_add(high(c.wrapping_add(high(*d, x)), x)), x));
        *sum = sum.wrapping_add(edge as u32);
    }
}
