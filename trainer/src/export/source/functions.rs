fn magnitude_of(x: f32) -> f32 {
    x.abs()
}

fn at_most(x: f32, high: f32) -> f32 {
    if x < high { x } else { high }
}

fn at_least(x: f32, low: f32) -> f32 {
    if x > low { x } else { low }
}

/// `x` within the trained range; NaN stays NaN.
fn held(x: f32, low: f32, high: f32) -> f32 {
    let below = if x > high { high } else { x };
    if below < low { low } else { below }
}

/// `value` within `limit` of 0; 0 for NaN.
fn limited(value: f32, limit: f32) -> f32 {
    at_least(at_most(if value.is_nan() { 0.0 } else { value }, limit), -limit)
}

fn cubic(c: &[f32; 4], t: f32) -> f32 {
    ((c[3] * t + c[2]) * t + c[1]) * t + c[0]
}

/// The way through a cell, from 1 to 2.
fn way(product: u64) -> f32 {
    f32::from_bits((product as u32) >> 9 | 0x3F80_0000)
}

fn exp_of_held(h: f32) -> f32 {
    let rounded = h * core::f32::consts::LOG2_E + 12_582_912.0;
    let n = rounded - 12_582_912.0;
    let r = h - n * 0.693_359_4;
    let r = r - n * -2.121_944_4e-4;
    let p = 1.987_569_1e-4;
    let p = p * r + 1.398_2e-3;
    let p = p * r + 8.333_452e-3;
    let p = p * r + 4.166_579_6e-2;
    let p = p * r + 0.166_666_66;
    let p = p * r + 0.5;
    let p = p * (r * r) + r + 1.0;
    p * f32::from_bits((rounded.to_bits() << 23).wrapping_add(0x3F80_0000))
}

fn f_exp(x: f32) -> f32 {
    exp_of_held(at_least(at_most(x, 88.37), -87.0))
}

/// `exp(-|x|)`.
fn f_decay(x: f32) -> f32 {
    exp_of_held(at_least(-x.abs(), -87.0))
}

/// `1 - exp(-ratio)` of a lag.
fn lag_share(ratio: f32) -> f32 {
    let x = at_least(at_most(ratio, 1.0e6), 0.0);
    let n = x * (1.0 + x * (0.5 + x * (1.0 / 6.0 + x * (1.0 / 24.0))));
    n / (1.0 + n)
}

/// `ln |x|`.
fn f_log(x: f32) -> f32 {
    let x = at_least(at_most(x.abs(), f32::MAX), f32::MIN_POSITIVE);
    let shifted = x.to_bits().wrapping_add(0x3F80_0000 - 0x3F35_04F3);
    let k = ((shifted >> 23) as i32 - 127) as f32;
    let f = f32::from_bits((shifted & 0x007F_FFFF) + 0x3F35_04F3) - 1.0;
    let s = f / (2.0 + f);
    let z = s * s;
    let w = z * z;
    let even = w * (0.400_009_72 + w * 0.242_790_79);
    let odd = z * (0.666_666_6 + w * 0.284_987_87);
    let half_square = 0.5 * f * f;
    s * (half_square + (odd + even)) + k * 9.058_001e-6 - half_square + f + k * 0.693_138_1
}

fn f_tanh(x: f32) -> f32 {
    let x = at_least(at_most(x, 7.905_311), -7.905_311);
    let z = x * x;
    let p = -2.760_768_5e-16;
    let p = p * z + 2.000_188e-13;
    let p = p * z + -8.604_672e-11;
    let p = p * z + 5.122_297e-8;
    let p = p * z + 1.485_722_4e-5;
    let p = p * z + 6.372_619e-4;
    let p = p * z + 4.893_524_6e-3;
    let q = 1.198_258_4e-6;
    let q = q * z + 1.185_347_1e-4;
    let q = q * z + 2.268_434_6e-3;
    let q = q * z + 4.893_525e-3;
    (x * p) / q
}

fn sin_half_turn(r: f32) -> f32 {
    let z = r * r;
    let p = -2.408_036_8e-8;
    let p = p * z + 2.753_647_5e-6;
    let p = p * z + -1.984_108_7e-4;
    let p = p * z + 8.333_333e-3;
    let p = p * z + -0.166_666_67;
    p * z * r + r
}

fn less_half_turns(x: f32, turns: f32) -> f32 {
    let r = x - turns * 3.140_625;
    let r = r - turns * 9.670_257_6e-4;
    r - turns * 6.278_329_5e-7
}

fn f_sin(x: f32) -> f32 {
    let x = at_least(at_most(x, 32768.0), -32768.0);
    let rounded = x * core::f32::consts::FRAC_1_PI + 12_582_912.0;
    let r = less_half_turns(x, rounded - 12_582_912.0);
    f32::from_bits(sin_half_turn(r).to_bits() ^ (rounded.to_bits() << 31))
}

fn f_cos(x: f32) -> f32 {
    let x = at_most(x.abs(), 32768.0);
    let rounded = x * core::f32::consts::FRAC_1_PI - 0.5 + 12_582_912.0;
    let r = less_half_turns(x, rounded - 12_582_912.0 + 0.5);
    f32::from_bits(sin_half_turn(r).to_bits() ^ (!rounded.to_bits() << 31))
}

fn f_atan(x: f32) -> f32 {
    let x = at_most(x, f32::MAX);
    let magnitude = x.abs();
    let beyond = magnitude > 1.0;
    let z = if beyond { 1.0 } else { magnitude } / if beyond { magnitude } else { 1.0 };
    let s = z * z;
    let p = -2.508_607_5e-3;
    let p = p * s + 1.399_660_7e-2;
    let p = p * s + -3.667_048_4e-2;
    let p = p * s + 6.318_236e-2;
    let p = p * s + -8.689_052e-2;
    let p = p * s + 0.110_420_376;
    let p = p * s + -0.142_796_16;
    let p = p * s + 0.199_997_9;
    let p = p * s + -0.333_333_3;
    let near = p * s * z + z;
    let angle = if beyond { core::f32::consts::FRAC_PI_2 - near } else { near };
    f32::from_bits(angle.to_bits() | (x.to_bits() & 0x8000_0000))
}

/// `|x|^p`; 0 at 0 for `p` above 0.
fn f_power(x: f32, p: f32) -> f32 {
    let result = f_exp(p * f_log(x));
    if x == 0.0 && p > 0.0 { 0.0 } else { result }
}

/// `sqrt |x|`, correctly rounded, digit by digit; subnormal numbers count as zero.
fn f_square_root(x: f32) -> f32 {
    let m = at_most(x.abs(), f32::MAX);
    let bits = at_least(m, f32::MIN_POSITIVE).to_bits();
    let exponent = (bits >> 23) + 127;
    let mut rest = u64::from((bits & 0x007F_FFFF) | 0x0080_0000) << if exponent & 1 == 1 { 26 } else { 25 };
    let (mut root, mut digit) = (0u64, 1u64 << 48);
    while digit != 0 {
        let taken = rest >= root + digit;
        rest -= if taken { root + digit } else { 0 };
        root = (root >> 1) + if taken { digit } else { 0 };
        digit >>= 2;
    }
    let rounded = ((root + 1) >> 1) as u32;
    if m < f32::MIN_POSITIVE { 0.0 } else { f32::from_bits(((exponent >> 1) << 23) + rounded - 0x0080_0000) }
}

/// -1, 0 or 1; 0 for NaN.
fn f_sign(x: f32) -> f32 {
    if x < 0.0 {
        -1.0
    } else if x > 0.0 {
        1.0
    } else {
        0.0
    }
}

fn least(x: f32, y: f32) -> f32 {
    if x < y { x } else { y }
}

fn most(x: f32, y: f32) -> f32 {
    if x > y { x } else { y }
}

fn squared(x: f32) -> f32 {
    x * x
}

fn divided(x: f32, y: f32) -> f32 {
    x / y
}

fn is_finite(x: f32) -> bool {
    x.is_finite()
}

/// Above 0 and at most 1.
fn is_period(dt: f32) -> bool {
    dt > 0.0 && dt <= 1.0
}

/// A table whose cells grow with `|x| + offset`; a side has origin, last position, cells per 2^32 and the bits that turn the sign.
fn geometric(table: &[[f32; 4]], x: f32, offset: f32, sides: &[[u32; 4]; 2]) -> f32 {
    let [origin, last, cells_per_turn, sign] = sides[(x.to_bits() >> 31) as usize];
    let position = (x.abs() + offset).to_bits().wrapping_sub(origin).min(last);
    let product = u64::from(position) * u64::from(cells_per_turn);
    let value = table.get((product >> 32) as usize).map_or(0.0, |cell| cubic(cell, way(product)));
    f32::from_bits(value.to_bits() ^ sign)
}

/// A table of equal cells.
fn uniform(table: &[[f32; 4]], x: f32, low: f32, scale: f32, place: &[u32; 2]) -> f32 {
    let position = ((x - low) * scale) as u32;
    let product = u64::from(position) * u64::from(place[1]);
    table.get(place[0] as usize + (product >> 32) as usize).map_or(0.0, |cell| cubic(cell, way(product)))
}

/// A sample within the trained ranges; `angle` is the position as measured.
#[derive(Default)]
#[allow(dead_code)]
struct Motion {
    velocity: f32,
    position: f32,
    load: f32,
    temperature: f32,
    angle: f32,
    law: f32,
    dt: f32,
    travel: f32,
}

fn smooth_sign(m: &Motion, width: f32) -> f32 {
    f_tanh(m.velocity / width)
}

/// Distance since the sample before; the memory is the position, and whether there was one.
fn travelled(memory: &mut [f32; 4], position: f32) -> f32 {
    let distance = position - if memory[1] == 1.0 { memory[0] } else { position };
    memory[0] = position;
    memory[1] = 1.0;
    distance
}

/// Lagged velocity (Hess & Soom 1990); the memory is it, and whether there was a sample before.
fn lagged(m: &Motion, memory: &mut [f32; 4], time_constant: f32) -> f32 {
    let before = if memory[1] == 1.0 { memory[0] } else { m.velocity };
    memory[0] = before + lag_share(m.dt / time_constant) * (m.velocity - before);
    memory[1] = 1.0;
    memory[0]
}

fn coulomb(m: &Motion, dry: f32, viscous: f32, width: f32) -> f32 {
    dry * smooth_sign(m, width) + viscous * m.velocity
}

fn stribeck(m: &Motion, amplitude: f32, velocity: f32, exponent: f32, width: f32) -> f32 {
    amplitude * f_exp(-f_power(m.velocity / velocity, exponent)) * smooth_sign(m, width)
}

fn power_viscous(m: &Motion, coefficient: f32, exponent: f32, width: f32) -> f32 {
    coefficient * f_power(m.velocity, exponent) * smooth_sign(m, width)
}

fn asymmetry(m: &Motion, dry: f32, viscous: f32, width: f32) -> f32 {
    dry * smooth_sign(m, width).abs() + viscous * m.velocity.abs()
}

fn temperature_friction(m: &Motion, reference: f32, dry: f32, viscous: f32, decay: f32, width: f32) -> f32 {
    let warmth = m.temperature - reference;
    let thinned = if decay > 0.0 { (1.0 - f_exp(-(decay * warmth))) / decay } else { warmth };
    dry * smooth_sign(m, width) * warmth + viscous * m.velocity * thinned
}

/// `c` is mean, difference and quadratic.
fn load_friction(m: &Motion, c: &[f32; 3], peak: f32, velocity: f32, width: f32) -> f32 {
    let sign = smooth_sign(m, width);
    let ratio = m.velocity / velocity;
    let coefficient = c[0] + peak * f_exp(-(ratio * ratio));
    coefficient * m.load.abs() * sign + c[1] * m.load * sign.abs() + c[2] * m.load * m.load * sign
}

/// The memory is the filtered dissipated power, and what the last additions put in too much (Kahan 1965); `c` is time constant and limit.
fn warm_up(m: &Motion, memory: &mut [f32; 4], c: &[f32; 2], dry: f32, viscous: f32, width: f32) -> f32 {
    let power = least((m.law * m.velocity).abs(), c[1]);
    let increment = lag_share(m.dt / c[0]) * (power - memory[0]) - memory[1];
    let sum = memory[0] + increment;
    memory[1] = (sum - memory[0]) - increment;
    memory[0] = least(most(sum, 0.0), c[1]);
    (dry * smooth_sign(m, width) + viscous * m.velocity) * memory[0]
}

/// A share of -1 to 1 after a way that leaves `left` of it.
fn turned_over(share: f32, travel: f32, left: f32) -> f32 {
    share * left + (1.0 - left).copysign(travel)
}

/// Maxwell slip elements of torque and distance (Dahl 1968; Al-Bender, Lampaert & Swevers 2005); the memory is their shares.
fn presliding(m: &Motion, memory: &mut [f32; 4], elements: &[[f32; 2]], width: f32) -> f32 {
    let (mut torque, mut slipping) = (0.0, 0.0);
    for ([most, distance], share) in elements.iter().zip(memory) {
        *share = turned_over(*share, m.travel, f_decay(m.travel / distance));
        torque = if elements.len() == 1 { most * *share } else { torque + most * *share };
        slipping = if elements.len() == 1 { *most } else { slipping + most };
    }
    torque - slipping * smooth_sign(m, width)
}

/// The memory is the time at rest, the way since, at most 20, and the latched torque; `c` is gain, time, distance, rest velocity, limit.
fn dwell_breakaway(m: &Motion, memory: &mut [f32; 4], c: &[f32; 5], width: f32) -> f32 {
    let resting = m.velocity.abs() < c[3];
    let longer = least(memory[0] + m.dt, c[4]);
    let farther = least(memory[1] + m.travel.abs() / c[2], 20.0);
    memory[2] = if resting { c[0] * f_log(1.0 + longer / c[1]) } else { memory[2] };
    memory[0] = if resting { longer } else { 0.0 };
    memory[1] = if resting { 0.0 } else { farther };
    memory[2] * f_decay(memory[1]) * smooth_sign(m, width)
}

/// Lines of order, cosine and sine.
fn ripple(m: &Motion, lines: &[[f32; 3]]) -> f32 {
    lines.iter().fold(0.0, |sum, [order, cosine, sine]| {
        let angle = order * m.angle;
        sum + (cosine * f_cos(angle) + sine * f_sin(angle))
    })
}

/// How far the link is behind; the memory is the link's position, and whether there was a sample before.
fn play(m: &Motion, memory: &mut [f32; 4], half_width: f32) -> f32 {
    let (low, high) = (m.position - half_width, m.position + half_width);
    let before = if memory[1] == 1.0 { memory[0] } else { m.position };
    memory[0] = least(most(before, low), high);
    memory[1] = 1.0;
    m.position - memory[0]
}

/// The memory is how far it is wound.
fn windup(m: &Motion, memory: &mut [f32; 4], torque: f32, distance: f32) -> f32 {
    memory[0] = turned_over(memory[0], m.travel, f_decay(m.travel / distance));
    torque * memory[0]
}

fn spring(m: &Motion, stiffness: f32, rest: f32) -> f32 {
    stiffness * (m.position - rest)
}
