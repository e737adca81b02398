//! The page's machine: a scene under the logic, or a board's line, behind three functions. The page writes a request into the buffer of
//! [`reserve`], [`ask`]s, and reads the [`answer`], both JSON. Nothing is generated, so nothing has to match a generator's version.

pub mod bench;
mod board;
mod talker;
mod unpack;

use std::sync::{Mutex, MutexGuard, PoisonError};

use serde_json::{Value, json};
use tenax_line::view::{View, command};
use tenax_sim::board::hash::of_scene;

use self::bench::Bench;
use self::board::Board;

enum Source {
    Bench(Box<Bench>),
    Board(Box<Board>),
}

#[derive(Default)]
struct Page {
    request: Vec<u8>,
    answer: Vec<u8>,
    source: Option<Source>,
}

static PAGE: Mutex<Page> = Mutex::new(Page { request: Vec::new(), answer: Vec::new(), source: None });

fn page() -> MutexGuard<'static, Page> {
    PAGE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A buffer for a request of so many bytes.
#[unsafe(no_mangle)]
pub extern "C" fn reserve(bytes: usize) -> *mut u8 {
    let mut page = page();
    page.request.clear();
    page.request.resize(bytes, 0);
    page.request.as_mut_ptr()
}

/// Does what the buffer asks for; length of the answer, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn ask() -> usize {
    let mut page = page();
    let answer = match serde_json::from_slice::<Value>(&page.request) {
        // The only answer that is not JSON.
        Ok(request) if text(&request, "do") == "recorded" => {
            page.answer = page.board().map(Board::recording).unwrap_or_default();
            return page.answer.len();
        }
        Ok(request) => page.done(&request).unwrap_or_else(|why| json!({ "error": why })),
        Err(error) => json!({ "error": error.to_string() }),
    };
    page.answer = answer.to_string().into_bytes();
    page.answer.len()
}

#[unsafe(no_mangle)]
pub extern "C" fn answer() -> *const u8 {
    page().answer.as_ptr()
}

/// Takes the buffer's bytes: 0, a captured line's; 1, a recording's (MCAP); 2, as they come up a board's line. Length of the answer, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn load(kind: u32) -> usize {
    let mut page = page();
    let bytes = std::mem::take(&mut page.request);
    let answer = match (kind, &mut page.source) {
        (2, Some(Source::Board(board))) => {
            board.hear(&bytes);
            json!({})
        }
        (2, _) => json!({ "error": "no board is connected" }),
        _ => match Board::recorded(bytes, kind == 1) {
            Ok(board) => {
                page.source = Some(Source::Board(Box::new(board)));
                json!({})
            }
            Err(why) => json!({ "error": why }),
        },
    };
    page.answer = answer.to_string().into_bytes();
    page.answer.len()
}

fn text<'a>(request: &'a Value, key: &str) -> &'a str {
    request[key].as_str().unwrap_or_default()
}

impl Page {
    /// Does one request. An error says what is wrong with it.
    fn done(&mut self, request: &Value) -> Result<Value, String> {
        match text(request, "do") {
            "scenes" => bench::scenes(),
            "bench" => {
                let settings = request["settings"].as_object().into_iter().flatten();
                let settings: Vec<(String, i32)> = settings
                    .filter_map(|(name, value)| Some((name.clone(), value.as_i64()?.try_into().ok()?)))
                    .collect();
                let seed = request["seed"].as_u64().unwrap_or(1);
                let bench = Bench::new(text(request, "scene"), seed, settings, text(request, "beside"))?;
                self.source = Some(Source::Bench(Box::new(bench)));
                self.go_on(request)
            }
            "board" => {
                self.source = Some(Source::Board(Box::new(Board::connected())));
                self.go_on(request)
            }
            "go on" => self.go_on(request),
            "record" => {
                let now_ms = request["now_ms"].as_u64().unwrap_or_default();
                self.board().ok_or("no board is connected")?.record(now_ms)?;
                Ok(json!({}))
            }
            "post" => self.post(text(request, "path")),
            "settings" => Ok(self.view()?.settings(true)),
            "backup" => {
                let now = std::time::SystemTime::UNIX_EPOCH
                    + std::time::Duration::from_millis(request["now_ms"].as_u64().unwrap_or_default());
                Ok(json!({ "text": self.view()?.backup(now) }))
            }
            "held" => {
                let (name, seed) = (text(request, "scene"), request["seed"].as_u64().unwrap_or(1));
                let (run, mut world) = bench::run(name, seed)?;
                Ok(json!({ "hash": of_scene(&run, &mut world).to_string() }))
            }
            other => Err(format!("nothing is called {other}")),
        }
    }

    fn board(&mut self) -> Option<&mut Board> {
        match &mut self.source {
            Some(Source::Board(board)) => Some(board),
            _ => None,
        }
    }

    fn view(&mut self) -> Result<&mut View, String> {
        match &mut self.source {
            Some(Source::Bench(bench)) => Ok(&mut bench.talker.view),
            Some(Source::Board(board)) => Ok(&mut board.talker.view),
            None => Err("there is no source yet".to_owned()),
        }
    }

    /// Lets time go by, or takes a line's bytes: changes of the view, bytes for the line, and the scene's state.
    fn go_on(&mut self, request: &Value) -> Result<Value, String> {
        let mut answer = json!({});
        match &mut self.source {
            Some(Source::Bench(bench)) => {
                bench.advance(request["frames"].as_u64().unwrap_or(0) as u32);
                answer["scene"] = bench.told();
            }
            Some(Source::Board(board)) => {
                answer["send"] = json!(board.go_on(request["now_s"].as_f64().unwrap_or(0.0)));
            }
            None => {}
        }
        let mut changes = self.view()?.take_changes();
        // The page shows the last readings alone.
        let newest = changes.iter().rposition(|change| change.get("sensors").is_some());
        let mut n = 0..;
        changes.retain(|change| n.next() == newest || change.get("sensors").is_none());
        answer["changes"] = Value::Array(changes);
        Ok(answer)
    }

    /// Carries out a path of the page, as `tenax monitor` does: status and text.
    fn post(&mut self, path: &str) -> Result<Value, String> {
        let answer = |status: u16, text: &str| json!({ "status": status, "text": text });
        if let Some(words) = path.strip_prefix("/selftest/") {
            let words: Vec<String> = words.split('/').map(str::to_owned).collect();
            return Ok(match self.view()?.selftest(&words) {
                Ok(()) => answer(202, "done"),
                Err(why) => answer(409, &format!("{why:#}")),
            });
        }
        let words = |stem| path.strip_prefix(stem).map(|words: &str| words.replace('/', " "));
        Ok(match (&mut self.source, command(path), words("/bench/"), words("/play/")) {
            (Some(Source::Bench(bench)), Some(command), ..) => {
                bench.command(command);
                answer(202, "sent")
            }
            (Some(Source::Bench(bench)), _, Some(act), _) => match bench.act(&act) {
                Ok(()) => answer(202, "sent"),
                Err(why) => answer(404, &why),
            },
            (Some(Source::Board(board)), Some(command), ..) if board.is_live() => {
                board.talker.ask(command);
                answer(202, "sent")
            }
            (Some(Source::Board(board)), _, _, Some(control)) => {
                board.control(&control);
                answer(202, "done")
            }
            _ => answer(404, "no such command"),
        })
    }
}
