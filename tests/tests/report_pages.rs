//! Pages in a browser: Chromium opens them as on a phone and as on a desk, uses their charts, and nothing is amiss; one looks as it did.
//! `FRIKAN_PAGES=FOLDER` keeps the pages and pictures of them there, `FRIKAN_WRITE=1` writes down how that one looks.

use std::path::{Path, PathBuf};

use frikan_tests::command::{called, run};
use frikan_tests::fixtures::folder;
use frikan_tests::pages::brightness::Brightness;
use frikan_tests::pages::browser::{chromium, framed, scripts};
use serde_json::Value;

/// Width and height of a window: a phone, a desk.
const WINDOWS: [(u32, u32); 2] = [(390, 844), (1280, 900)];
/// Smallest letters, pixels.
const SMALLEST_LETTER: f64 = 11.0;
/// Bytes of a page at most.
const MOST_BYTES: usize = 1_500_000;

/// Tries until a frame was started in time.
const TRIES: usize = 3;

/// What the scripts of `tests/browser` saw of a page.
fn inspect(browser: &Path, page: &Path, window: (u32, u32)) -> Value {
    let script = |name: &str| format!("<script>{}</script>", std::fs::read_to_string(scripts().join(name)).unwrap());
    let axe = scripts().join("../../target/pages/axe_playwright_python/axe.min.js");
    let axe = std::fs::read_to_string(axe).map_or_else(
        |_| {
            eprintln!("skipped: no axe-core under target/pages (tests/setup.sh installs it where there is a network)");
            String::new()
        },
        |source| format!("<script>{source}</script>"),
    );
    let text = std::fs::read_to_string(page).unwrap();
    let text = text.replacen("<head>", &format!("<head>{}", script("before.js")), 1);
    let (start, end) = text.split_at(text.rfind("</body>").unwrap());
    let text = [start, &axe, &script("after.js"), end].concat();
    let seen = (0..TRIES).find_map(|_| {
        let shown = framed(browser, page, window, &text, None);
        let (_, seen) = shown.split_once("<pre id=\"inspected\">")?;
        Some(seen.split_once("</pre>")?.0.to_owned())
    });
    let json = seen.unwrap_or_else(|| panic!("{}: nothing seen", page.display()));
    let json = json.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&");
    serde_json::from_str(&json).unwrap_or_else(|error| panic!("{error}: {json}"))
}

#[test]
fn pages_can_be_read_and_used_on_a_phone_and_at_a_desk() {
    let Some(browser) = chromium() else { return };
    let bench = tempfile::tempdir().unwrap();
    let kept = std::env::var_os("FRIKAN_PAGES").map(PathBuf::from);
    let at = kept.as_deref().unwrap_or(bench.path());
    let fixture = |name: &str| folder().join(name).display().to_string();
    let (joint, recording, test) = (fixture("elbow.toml"), fixture("stribeck.csv"), fixture("stribeck-test.csv"));
    for (line, status) in [
        (format!("simulate {joint} --effect presliding=1 --duration 20 --seed 7 -o real.csv"), 0),
        (format!("simulate {joint} --duration 20 --seed 7 -o simulated.csv"), 0),
        (format!("diagnose real.csv --joint {joint} -o itself.frk --report itself.html"), 1),
        (
            format!(
                "diagnose real.csv --simulation simulated.csv --joint {joint} -o better.frk --report simulation.html"
            ),
            1,
        ),
        (format!("fit {recording} --test {test} -o law.frk --report fit.html"), 0),
        (format!("loop {joint} --image better.frk --duration 2 --report loop.html"), 0),
    ] {
        let done = run(at, &line.split_whitespace().chain(["--quiet"]).collect::<Vec<_>>());
        assert_eq!(done.status, status, "{line}: {}", done.messages);
    }
    for name in ["itself", "simulation", "fit", "loop"] {
        let page = at.join(name).with_extension("html");
        assert!(std::fs::metadata(&page).unwrap().len() as usize <= MOST_BYTES, "{name} is too large");
        for window in WINDOWS {
            let seen = inspect(&browser, &page, window);
            let is = |key: &str, value: Value| assert_eq!(seen[key], value, "{name} at {window:?}: {key} of {seen}");
            is("width", window.0.into());
            is("errors", Value::Array(Vec::new()));
            is("undrawn", 0.into());
            is("zoomed", Value::from(vec![true, true]));
            is("whole", Value::from(vec![true, true]));
            is("toggled", "false".into());
            assert!(seen["told"].as_str().is_some_and(|told| told.starts_with("at ")), "{name}: {seen}");
            assert!(
                seen["saved"][0].as_str().is_some_and(|head| head.contains(" (") || head.contains(", ")),
                "{name}: {seen}"
            );
            assert!(seen["overflow"].as_f64().unwrap() <= 0.0, "{name} at {window:?}: {seen}");
            is("cut", Value::Array(Vec::new()));
            assert!(seen["smallest"].as_f64().unwrap() >= SMALLEST_LETTER, "{name} at {window:?}: {seen}");
            assert!(seen["axe"].as_array().is_none_or(Vec::is_empty), "{name} at {window:?}: {:#}", seen["axe"]);
            if ["itself", "simulation"].contains(&name) {
                is("answered", Value::from(vec!["Where", "How much", "How sure", "What to do"]));
                let below = seen["answered_above"].as_f64().unwrap();
                assert!(below < f64::from(window.1), "{name} at {window:?}: the answer ends at {below}");
                // What puts a simulator right stands there once.
                let text = std::fs::read_to_string(&page).unwrap();
                assert_eq!(text.matches("<dd class=\"command\">In the simulator: ").count(), 1, "{name}");
            }
            if kept.is_some() {
                let picture = at.join(format!("{name}-{}.png", window.0));
                let text = std::fs::read_to_string(&page).unwrap();
                framed(&browser, &page, (window.0, 3000), &text, Some(&picture));
            }
        }
    }
}

/// The only font of the page whose looks are compared, so that its lines break in the same places wherever it is shown.
const FONT: &str = "<style>* { font-family: 'DejaVu Sans' !important }</style></head>";
/// Cells of a page that may look otherwise than they did: another version of the browser, a digit of a figure. A curve takes more.
const SHARE_CHANGED: f64 = 0.005;

/// The page of a golden image in closed loop, which no fit changes.
#[test]
fn a_page_looks_as_it_did() {
    let Some(browser) = chromium() else { return };
    let bench = tempfile::tempdir().unwrap();
    let at = bench.path();
    let fixture = |name: &str| folder().join(name).display().to_string();
    let (joint, image) = (fixture("elbow.toml"), fixture("elbow.frk"));
    called(at, &format!("loop {joint} --image {image} --duration 2 --report loop.html --quiet"));
    let page = at.join("loop.html");
    let text = std::fs::read_to_string(&page).unwrap().replacen("</head>", FONT, 1);
    let looks = |text: &str, window: (u32, u32)| {
        let picture = at.join("picture.png");
        framed(&browser, &page, window, text, Some(&picture));
        Brightness::of_picture(&picture)
    };
    let looked = WINDOWS.map(|window| {
        let now = looks(&text, window);
        let reference = scripts().join(format!("loop-{}.png", window.0));
        if std::env::var_os("FRIKAN_WRITE").is_some() {
            now.save(&reference);
        }
        let looked = Brightness::load(&reference);
        let share = now.share_changed(&looked);
        assert!(
            share <= SHARE_CHANGED,
            "{share:.4} of the page looks otherwise at {window:?}; FRIKAN_WRITE=1 takes it"
        );
        looked
    });
    // It would be seen that no chart is drawn.
    let undrawn = text.replacen("</head>", "<style>.plot canvas { visibility: hidden }</style></head>", 1);
    let share = looks(&undrawn, WINDOWS[0]).share_changed(&looked[0]);
    assert!(share > 2.0 * SHARE_CHANGED, "{share:.4}");
}
