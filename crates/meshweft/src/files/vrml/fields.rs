//! The fields of a face set, and lists of numbers.

use std::ops::Range;

use super::lexer::{Token, is_number};
use super::reader::VrmlReader;
use super::scene::{List, Role};
use crate::files::error::{Fault, FileErrorKind};
use crate::files::text::shown;

impl VrmlReader<'_> {
    /// Reads a field of a face set.
    pub(super) fn face_set_word(&mut self, span: Range<usize>) -> Result<(), Fault> {
        let word = &self.text[span.clone()];
        let named = |which: usize| {
            let mut roles = Role::ALL.into_iter();
            roles.find(|role| role.names()[which].as_bytes() == word)
        };

        if let Some(role) = named(3) {
            let list = self.list(span)?;
            let Some((set, _)) = self.face_set() else {
                return Ok(());
            };
            match list {
                None => set.obstacle(format!("its {} IS one of a PROTO", role.index_field())),
                Some(_) if set.indices[role as usize].is_some() => {
                    set.obstacle(format!("it has two fields {}", role.index_field()));
                }
                list => set.indices[role as usize] = list,
            }
            return Ok(());
        }

        let field = named(0);
        let is_value = matches!(
            word,
            b"ccw" | b"convex" | b"solid" | b"creaseAngle" | b"TRUE" | b"FALSE"
        ) || is_number(word);
        let per_face = match word {
            b"normalPerVertex" | b"colorPerVertex" => Some(self.is_false()?),
            _ => None,
        };
        let is_node = field.is_none() && self.lexer.clone().skip() == Some(b'{');
        let Some((set, role)) = self.face_set() else {
            return Ok(());
        };
        match (field, per_face) {
            (Some(field), _) => *role = Some(field),
            (_, Some(None)) => set.obstacle("a field IS one of a PROTO"),
            (_, Some(Some(per_face))) if word[0] == b'n' => set.normal_per_face = per_face,
            (_, Some(Some(per_face))) => set.color_per_face = per_face,
            _ if is_node => self.word = Some(span),
            _ if is_value => {}
            _ => set.obstacle(format!("its field {} may go by numbers", shown(word))),
        }
        Ok(())
    }

    /// Whether the word that comes is `FALSE`; `None` if it is `IS`.
    fn is_false(&mut self) -> Result<Option<bool>, Fault> {
        let at = self.lexer.at();
        let word = self.lexer.word().unwrap_or(at..at);
        match &self.text[word.clone()] {
            b"TRUE" => Ok(Some(false)),
            b"FALSE" => Ok(Some(true)),
            b"IS" => {
                self.name_after("IS")?;
                Ok(None)
            }
            other => {
                let text = format!("{} where TRUE or FALSE is expected", shown(other));
                Err(Fault::malformed(word.start, text))
            }
        }
    }

    /// Reads the list after the field at `field`; `None` if it `IS` one of a PROTO.
    pub(super) fn list(&mut self, field: Range<usize>) -> Result<Option<List>, Fault> {
        let first = self.lexer.clone().token()?;
        if matches!(&first, Some(Token::Word(word)) if &self.text[word.clone()] == b"IS") {
            self.lexer.word();
            self.name_after("IS")?;
            return Ok(None);
        }
        let in_brackets = matches!(first, Some(Token::Mark(b'[', _)));
        if in_brackets {
            self.lexer.token()?;
        }

        let start = self.lexer.at();
        let mut list = List {
            content: start..start,
            count: 0,
        };

        loop {
            let mut ahead = self.lexer.clone();
            match ahead.token()? {
                Some(Token::Word(word)) if is_number(&self.text[word.clone()]) => {
                    if list.count == 0 {
                        list.content.start = word.start;
                    }
                    list.count += 1;
                    list.content.end = word.end;
                    self.lexer = ahead;
                }
                Some(Token::Mark(b']', _)) if in_brackets => {
                    self.lexer = ahead;
                    return Ok(Some(list));
                }
                _ if !in_brackets && list.count > 0 => return Ok(Some(list)),
                Some(other) => {
                    let found = shown(&self.text[other.span()]);
                    let field = shown(&self.text[field]);
                    let text = format!("{found} where a number of {field} is expected");
                    return Err(Fault::malformed(other.span().start, text));
                }
                None => {
                    let field = shown(&self.text[field.clone()]);
                    let kind = FileErrorKind::truncated(format!("the numbers of {field}"));
                    let at = self.text.len();
                    return Err(Fault { at, kind });
                }
            }
        }
    }

    /// The names of the nodes of a `ROUTE a.x TO b.y`.
    pub(super) fn route(&mut self, at: usize) -> Result<(), Fault> {
        let text = self.text;
        let node = |span: Range<usize>| {
            let word = &text[span];
            let end = word.iter().position(|&b| b == b'.');
            &word[..end.unwrap_or(word.len())]
        };
        let from = self.name_after("ROUTE")?;
        self.scene.routed.insert(node(from));
        // Dots may be words of their own.
        for _ in 0..3 {
            let word = self.name_after("ROUTE")?;
            if &text[word] == b"TO" {
                let to = self.name_after("TO")?;
                self.scene.routed.insert(node(to));
                return Ok(());
            }
        }
        Err(Fault::malformed(at, "a ROUTE without the word TO"))
    }

    /// The word that must follow `keyword`.
    pub(super) fn name_after(&mut self, keyword: &str) -> Result<Range<usize>, Fault> {
        let word = self.lexer.word();
        word.ok_or_else(|| {
            let at = self.lexer.at();
            match at < self.text.len() {
                true => Fault::malformed(at, format!("no name after {keyword}")),
                false => {
                    let kind = FileErrorKind::truncated(format!("what follows {keyword}"));
                    Fault { at, kind }
                }
            }
        })
    }
}
