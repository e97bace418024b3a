//! tmp
use frikan_tests::laws::{other, reference};
#[test]
fn other() {
    let only: f64 = std::env::var("SHARE").unwrap().parse().unwrap();
    let mut right = 0;
    for seed in 700..710 {
        for case in other::cases(seed) {
            let name = case.name;
            match case.mistaken(only, seed) { None => right += 1, Some(w) => println!("{only} {name} {:?} {:?}", w.sign(), w.terms().iter().map(|t| t.shape).collect::<Vec<_>>()) }
        }
    }
    println!("{only}: {right}");
}
#[test]
fn refer() {
    for j in [2, 4, 5] {
        let t = reference::tally(j, 9000..9020);
        println!("joint {j} {} {:?} {:?}", t.right, t.inside, t.wrong.iter().map(|w| (w.sign(), w.terms().iter().map(|t| t.shape).collect::<Vec<_>>())).collect::<Vec<_>>());
    }
}
