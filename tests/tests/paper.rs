//! The paper's experiments in short: each runs, and none falls behind the published figure or pykan's. All draws with
//! `FRIKAN_EXHAUSTIVE=1`.

use frikan_tests::exhaustive;
use frikan_tests::laws::reference;
use frikan_tests::paper::network::{learn, noisy_r2};
use frikan_tests::paper::page::{NOISY_R2_WANTED, PYKAN_CLEAN_RMSE, PYKAN_NOISY_R2, files};
use frikan_tests::paper::spline_peer::at_equal_count;
use frikan_tests::paper::symbolic::symbolic;
use frikan_tests::paper::{Effort, JOINTS, median};

fn seeds() -> u64 {
    if exhaustive() { Effort::FULL.seeds } else { Effort::SHORT.seeds }
}

#[test]
fn clean_networks_beat_pykan() {
    for (j, pykan) in PYKAN_CLEAN_RMSE.into_iter().enumerate() {
        let worst = (0..seeds()).map(|seed| learn(j, 0.0, seed).rmse[2]).fold(0.0, f64::max);
        println!("joint {}: worst {worst:.4} N m", j + 1);
        assert!(worst < 0.3 * pykan && worst <= 0.004, "joint {}: {worst}", j + 1);
    }
}

/// With as many coefficients a network is no worse than the spline that a statistician would pick, in 19 draws of 20.
#[test]
fn networks_beat_the_spline_of_as_many_coefficients() {
    for j in 0..JOINTS.len() {
        for share in [0.0, 0.025] {
            let worse = (0..seeds()).filter(|seed| {
                let [network, spline] = at_equal_count(j, share, *seed);
                network >= spline
            });
            let worse: Vec<u64> = worse.collect();
            assert!(20 * worse.len() as u64 <= seeds(), "joint {}, noise {share}: seeds {worse:?}", j + 1);
        }
    }
}

#[test]
fn noisy_networks_keep_to_the_clean_truth() {
    for j in 0..JOINTS.len() {
        let r2 = noisy_r2(j, seeds());
        let worst = r2.iter().copied().fold(f64::INFINITY, f64::min);
        println!("joint {}: median {:.5}, worst {worst:.5}", j + 1, median(&r2));
        assert!(worst > PYKAN_NOISY_R2[j], "joint {}: {worst}", j + 1);
        assert!(median(&r2) >= NOISY_R2_WANTED[j], "joint {}: {r2:?}", j + 1);
    }
}

#[test]
fn the_formula_is_the_law_itself() {
    let clean = symbolic(0, 0.0, 0);
    assert_eq!(clean.found.law.structure, reference::whole());
    assert!(clean.r2 > 1.0 - 1e-12 && clean.nodes <= 20, "{}", clean.formula);
    let noisy = symbolic(1, 0.025, 0);
    assert_eq!(noisy.found.law.structure, reference::dry());
    assert!(noisy.r2 > 0.999, "{}", noisy.r2);
}

/// Every section of the page comes out, with the pictures that it shows.
#[test]
fn the_page_shows_only_pictures_that_are_there() {
    let files = files(Effort { seeds: 1, coverage: 2 }).unwrap();
    let (_, page) = files.last().unwrap();
    for experiment in ["P1", "P2", "P3", "P4", "P5", "P6", "P7"] {
        assert!(page.contains(experiment), "{experiment}");
    }
    let shown =
        page.split("](paper/").skip(1).filter_map(|rest| rest.split_once(')')).map(|(name, _)| format!("paper/{name}"));
    let mut count = 0;
    for name in shown {
        assert!(files.iter().any(|(file, svg)| *file == name && svg.starts_with("<svg xmlns")), "{name}");
        count += 1;
    }
    assert!(count > 10);
}
