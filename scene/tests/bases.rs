//! `base = "glass"` and then what differs: what is taken over, and where a mistake is said to be.

use std::borrow::Cow;

use tenax_scene::SceneFile;

const BASE: &str =
    concat!(crate::common::grasp!(), "[[knock]]\nat_s = 1\npeak_mv = 40\nring_hz = 400\ndecay_ms = 4\n");

fn upon(own: &str, under: &'static str) -> Result<SceneFile, String> {
    let text = format!("name = \"n\"\nbase = \"under\"\ntitle = \"t\"\n{own}");
    let find = |name: &str| (name == "under").then(|| ("bases/under.toml".to_owned(), Cow::Borrowed(under)));
    SceneFile::parse_upon(&text, "my.toml", &find).map_err(|error| error.to_string())
}

fn told(scene: &SceneFile) -> String {
    let shown = format!("{scene:?}");
    let mut parts = shown.split("span: ");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |told, part| told + part.split_once(',').map_or("", |(_, rest)| rest))
}

#[test]
fn a_scene_is_its_base_and_what_it_changes() {
    let written_out = BASE.replace("mu_s = 0.5", "mu_s = 0.6").replace("duration_s = 10", "duration_s = 12");
    let knock = "[[knock]]\nat_s = 2\npeak_mv = 60\nring_hz = 300\ndecay_ms = 5\n";
    let whole = format!("name = \"n\"\ntitle = \"t\"\n{written_out}{knock}");
    let whole = SceneFile::parse(&whole, "my.toml").unwrap();
    let own = upon(&format!("duration_s = 12\n[contact]\nmu_s = 0.6\n{knock}"), BASE).unwrap();
    assert_eq!(told(&own), told(&whole), "keys of a table one by one, entries of a list after the base's");

    let quiet = BASE.split("[[knock]]").next().unwrap();
    let quiet = SceneFile::parse(&format!("name = \"n\"\ntitle = \"t\"\n{quiet}"), "my.toml").unwrap();
    let without = upon("without = [\"knock\"]\n", BASE).unwrap();
    assert_eq!(told(&without), told(&quiet));
    assert_ne!(told(&without), told(&upon("", BASE).unwrap()), "the control");
}

#[test]
fn a_mistake_is_named_in_the_file_in_which_it_stands() {
    let cases = [
        ("[contact]\nmu_s = 50\n", BASE, "my.toml:5: mu_s: 50 is outside"),
        ("[contact]\nmu_d = 0.6\n", BASE, "my.toml:5: mu_d = 0.6 is greater than mu_s = 0.5"),
        // The scene's own number makes the base's one wrong: it is told where that stands.
        ("[contact]\nmu_s = 0.3\n", BASE, "bases/under.toml:6: mu_d = 0.4 is greater than mu_s = 0.3"),
        ("duration_s = 0.5\n", BASE, "bases/under.toml:14: 1 s is after the scene's end"),
        ("[contcat]\nmu_s = 0.3\n", BASE, "my.toml:4: unknown field `contcat`"),
        ("", "[contact]\nmu_s = 50\n", "bases/under.toml:2: mu_s: 50 is outside"),
        ("", "[contact]\nmu_s 0.5\n", "bases/under.toml:2: "),
        ("", "duration_s = 10\n", "missing field"),
        ("without = [\"wet\"]\n", BASE, "my.toml:4: without: the base has no \"wet\""),
        ("without = \"knock\"\n", BASE, "my.toml:4: without: a list"),
        ("fault = [\n    { at_s = 1, channel = \"fsr_x\" },\n]\n", BASE, "my.toml:5: channel: no channel"),
    ];
    for (own, under, said) in cases {
        let message = upon(own, under).expect_err(own);
        assert!(message.contains(said), "{own}: {message}");
        assert_eq!(message.contains("(a base of my.toml)"), message.starts_with("bases/"), "{message}");
    }
}

#[test]
fn a_base_that_is_not_there_or_stands_on_the_scene_is_refused() {
    let missing = |text: &str| SceneFile::parse(text, "my.toml").unwrap_err().to_string();
    let said = missing("name = \"n\"\nbase = \"glas\"\n");
    assert!(said.starts_with("my.toml:2: base: no scene is called `glas`; near it: glass"), "{said}");
    assert!(missing("base = 3\n").starts_with("my.toml:1: base: integer is no name"));
    // Its own name and title are its own.
    assert!(missing("base = \"glass\"\ntitle = \"t\"\n").contains("missing field `name`"));
    assert!(missing("base = \"glass\"\nname = \"n\"\n").contains("missing field `title`"));

    let circle = |name: &str| {
        let other = if name == "one" { "two" } else { "one" };
        Some((format!("{name}.toml"), Cow::Owned(format!("duration_s = 1\nbase = \"{other}\"\n"))))
    };
    let text = "name = \"n\"\nbase = \"one\"\n";
    let said = SceneFile::parse_upon(text, "my.toml", &circle).unwrap_err().to_string();
    assert_eq!(said, "two.toml:2: base: one.toml stands on itself (a base of my.toml)");
    let own = |_: &str| Some(("my.toml".to_owned(), Cow::Borrowed("")));
    let said = SceneFile::parse_upon("base = \"my\"\n", "my.toml", &own).unwrap_err().to_string();
    assert_eq!(said, "my.toml:1: base: my.toml stands on itself");
}

#[test]
fn the_example_of_the_page_is_one() {
    let page = include_str!("../../docs/scenes.md");
    let (_, rest) = page.split_once("    name = \"my-glass\"").expect("docs/scenes.md has the example");
    let block: Vec<&str> =
        rest.lines().skip(1).take_while(|line| line.is_empty() || line.starts_with("    ")).collect();
    let scene = SceneFile::parse(&format!("name = \"my-glass\"\n{}", block.join("\n")), "my-glass.toml");
    assert_eq!(scene.unwrap_or_else(|error| panic!("{error}")).duration_s(), 60.0);
}
