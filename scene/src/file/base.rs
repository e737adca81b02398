//! A scene that says only how it differs from another: `base = "glass"`. A table of the scene changes the keys that it names, an entry of a
//! list (`[[knock]]`) comes after those of the base, and `without = ["knock"]` takes a table or list of the base away first. `name` and
//! `title` are never the base's. A base may itself have one.
//!
//! What neither says is in `defaults.toml`. All texts stand one after the other in one space of bytes, so that a span tells the file as
//! well.

use std::borrow::Cow;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::{SceneError, near};

pub type Find<'a> = &'a dyn Fn(&str) -> Option<(String, Cow<'static, str>)>;

const BASE: &str = "base";
const WITHOUT: &str = "without";
const OWN: [&str; 2] = ["name", "title"];
const DEFAULTS: &str = include_str!("defaults.toml");
/// Tables whose defaults hold only where a scene names them.
const ON_REQUEST: [&str; 4] = ["contact", "robot", "photoelastic", "skin"];

struct Source {
    file: String,
    text: Cow<'static, str>,
    start: usize,
}

pub(super) struct Sources(Vec<Source>);

impl Sources {
    pub(super) fn read(text: &str, file_name: &str, find: Find<'_>) -> Result<Self, SceneError> {
        let mut sources = Self(Vec::new());
        let mut next = Some((file_name.to_owned(), Cow::Owned(text.to_owned()), 0..0));
        while let Some((file, text, asked_at)) = next {
            if sources.0.iter().any(|source| source.file == file) {
                return Err(sources.wrong(asked_at, format!("base: {file} stands on itself")));
            }
            sources.push(file, text);
            next = sources.next(find)?;
        }
        sources.push("defaults.toml".to_owned(), Cow::Borrowed(DEFAULTS));
        Ok(sources)
    }

    fn push(&mut self, file: String, text: Cow<'static, str>) {
        let start = self.0.last().map_or(0, |last| last.start + last.text.len() + 1);
        self.0.push(Source { file, text, start });
    }

    #[expect(clippy::type_complexity, reason = "the next source and where it is asked for, used once")]
    fn next(&self, find: Find<'_>) -> Result<Option<(String, Cow<'static, str>, Range<usize>)>, SceneError> {
        let Some(last) = self.0.last() else { return Ok(None) };
        let table = self.table(last)?;
        let Some(base) = table.get(BASE) else { return Ok(None) };
        let at = base.span();
        let name = match base.get_ref() {
            DeValue::String(name) => name,
            other => return Err(self.wrong(at, format!("base: {} is no name of a scene", other.type_str()))),
        };
        match find(name) {
            Some((file, text)) => Ok(Some((file, text, at))),
            None => {
                let known = crate::builtin().iter().chain(crate::builtin::parts());
                let near = near(name, known.map(|(known, _)| *known));
                Err(self.wrong(at, format!("base: no scene is called `{name}`; near it: {near}")))
            }
        }
    }

    pub(super) fn with_defaults(&self) -> Result<Spanned<DeTable<'_>>, SceneError> {
        let scene = self.merged()?;
        let span = scene.span();
        let scene = scene.into_inner();
        let Some(defaults) = self.0.last() else { return Ok(Spanned::new(span, scene)) };
        let mut whole = self.table(defaults)?;
        for key in ON_REQUEST.into_iter().filter(|key| !scene.contains_key(*key)) {
            whole.remove(key);
        }
        put_over(scene, &mut whole);
        Ok(Spanned::new(span, whole))
    }

    pub(super) fn merged(&self) -> Result<Spanned<DeTable<'_>>, SceneError> {
        let mut sources = self.0.iter().rev().skip(1);
        let Some(first) = sources.next() else { return Ok(Spanned::new(0..0, DeTable::new())) };
        let mut whole = self.table(first)?;
        let mut span = first.start..first.start + first.text.len();
        whole.remove(BASE);
        for source in sources {
            let mut own = self.table(source)?;
            span = source.start..source.start + source.text.len();
            own.remove(BASE);
            OWN.into_iter().for_each(|key| drop(whole.remove(key)));
            self.leave_out(own.remove(WITHOUT), &mut whole)?;
            put_over(own, &mut whole);
        }
        Ok(Spanned::new(span, whole))
    }

    fn leave_out(
        &self,
        without: Option<Spanned<DeValue<'_>>>,
        base: &mut DeTable<'_>,
    ) -> Result<(), SceneError> {
        let Some(without) = without else { return Ok(()) };
        let DeValue::Array(names) = without.get_ref() else {
            return Err(self.wrong(without.span(), "without: a list of the base's tables".to_owned()));
        };
        for name in names.iter() {
            let taken = name.get_ref().as_str().and_then(|key| base.remove(key));
            if taken.is_none() {
                let what = format!("without: the base has no {}", self.text(name.span()));
                return Err(self.wrong(name.span(), what));
            }
        }
        Ok(())
    }

    fn table<'a>(&'a self, source: &'a Source) -> Result<DeTable<'a>, SceneError> {
        let table = DeTable::parse(&source.text).map_err(|error| {
            let span = error.span().unwrap_or(0..0);
            self.of_toml(source.start + span.start..source.start + span.end, error.message())
        })?;
        Ok(moved_table(table.into_inner(), source.start))
    }

    fn text(&self, span: Range<usize>) -> &str {
        let source = self.source(&span);
        source.text.get(span.start - source.start..span.end - source.start).unwrap_or_default()
    }

    fn source(&self, span: &Range<usize>) -> &Source {
        self.0.iter().rev().find(|source| source.start <= span.start).unwrap_or(&self.0[0])
    }

    pub(super) fn wrong(&self, span: Range<usize>, mut what: String) -> SceneError {
        let source = self.source(&span);
        if source.start > 0 {
            what += &format!(" (a base of {})", self.0[0].file);
        }
        let before = source.text.get(..span.start - source.start).unwrap_or(&source.text);
        SceneError { file: source.file.clone(), line: before.matches('\n').count() + 1, what }
    }

    pub(super) fn of_toml(&self, span: Range<usize>, message: &str) -> SceneError {
        let message = message.replace('\n', "; ");
        let source = self.source(&span);
        let before = source.text.get(..span.start - source.start).unwrap_or_default();
        let line = before.rsplit('\n').next().unwrap_or_default();
        let what = match line.rsplit_once('=') {
            Some((keys, _)) => {
                let key = keys.rsplit([',', '{']).next().unwrap_or_default();
                format!("{}: {message}", key.trim())
            }
            None => message,
        };
        self.wrong(span, what)
    }
}

fn put_over<'a>(own: DeTable<'a>, base: &mut DeTable<'a>) {
    for (key, value) in own {
        let span = value.span();
        let value = match (value.into_inner(), base.remove(&key).map(Spanned::into_inner)) {
            (DeValue::Table(own), Some(DeValue::Table(mut under))) => {
                put_over(own, &mut under);
                DeValue::Table(under)
            }
            // A list of numbers is one value.
            (DeValue::Array(own), Some(DeValue::Array(mut all)))
                if own.iter().chain(all.iter()).all(|entry| entry.get_ref().is_table()) =>
            {
                own.into_iter().for_each(|entry| all.push(entry));
                DeValue::Array(all)
            }
            (own, _) => own,
        };
        base.insert(key, Spanned::new(span, value));
    }
}

fn moved_table(table: DeTable<'_>, by: usize) -> DeTable<'_> {
    table.into_iter().map(|(key, value)| (moved(key, by), moved_value(value, by))).collect()
}

fn moved_value(value: Spanned<DeValue<'_>>, by: usize) -> Spanned<DeValue<'_>> {
    let value = moved(value, by);
    let span = value.span();
    let inner = match value.into_inner() {
        DeValue::Table(table) => DeValue::Table(moved_table(table, by)),
        DeValue::Array(array) => DeValue::Array(array.into_iter().map(|one| moved_value(one, by)).collect()),
        plain => plain,
    };
    Spanned::new(span, inner)
}

fn moved<T>(one: Spanned<T>, by: usize) -> Spanned<T> {
    let span = one.span();
    Spanned::new(span.start + by..span.end + by, one.into_inner())
}
