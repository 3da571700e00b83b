//! Where the strings of `/buffers/N/uri` stand in the JSON text, so that they can be replaced
//! without writing the rest of it anew.

use std::ops::Range;

/// The span of each buffer's `uri` string, quotes included, by buffer number.
///
/// `json` has been parsed before: it is sound, and nested no deeper than the parser allows. Where a
/// name comes twice in an object the last one counts, as it does for the parser.
pub(super) fn buffer_uri_spans(json: &[u8]) -> Vec<Option<Range<usize>>> {
    let mut scan = Scan { json, position: 0 };
    let mut spans = Vec::new();
    scan.object(|scan, name| match name == "buffers" {
        true => {
            spans.clear();
            scan.array(|scan| {
                let mut uri = None;
                scan.object(|scan, name| {
                    let start = scan.position;
                    scan.skip_value();
                    if name == "uri" {
                        uri = Some(start..scan.position);
                    }
                });
                spans.push(uri);
            });
        }
        false => scan.skip_value(),
    });
    spans
}

struct Scan<'a> {
    json: &'a [u8],
    position: usize,
}

impl Scan<'_> {
    /// The next byte that is not white space, without taking it.
    fn peek(&mut self) -> Option<u8> {
        while let Some(b' ' | b'\t' | b'\n' | b'\r') = self.json.get(self.position) {
            self.position += 1;
        }
        self.json.get(self.position).copied()
    }

    /// Takes the next byte if it is this one.
    fn take(&mut self, byte: u8) -> bool {
        let found = self.peek() == Some(byte);
        self.position += usize::from(found);
        found
    }

    /// Calls `field` with each name of an object; it must take the value. Skips anything else.
    fn object(&mut self, mut field: impl FnMut(&mut Self, &str)) {
        if !self.take(b'{') {
            return self.skip_value();
        }
        while self.peek().is_some_and(|byte| byte != b'}') {
            let start = self.position;
            self.skip_string();
            let name: String =
                serde_json::from_slice(&self.json[start..self.position]).unwrap_or_default();
            self.take(b':');
            self.peek();
            field(self, &name);
            self.take(b',');
        }
        self.take(b'}');
    }

    /// Calls `element` at each element of an array; it must take it. Skips anything else.
    fn array(&mut self, mut element: impl FnMut(&mut Self)) {
        if !self.take(b'[') {
            return self.skip_value();
        }
        while self.peek().is_some_and(|byte| byte != b']') {
            element(self);
            self.take(b',');
        }
        self.take(b']');
    }

    fn skip_value(&mut self) {
        let mut depth = 0_usize;
        while let Some(byte) = self.peek() {
            match byte {
                b'"' => self.skip_string(),
                b'{' | b'[' => {
                    depth += 1;
                    self.position += 1;
                }
                b'}' | b']' => {
                    depth = depth.saturating_sub(1);
                    self.position += 1;
                }
                b',' | b':' => self.position += 1,
                _ => self.skip_word(),
            }
            if depth == 0 {
                return;
            }
        }
    }

    fn skip_string(&mut self) {
        self.position += 1;
        while let Some(&byte) = self.json.get(self.position) {
            self.position += if byte == b'\\' { 2 } else { 1 };
            if byte == b'"' {
                break;
            }
        }
        self.position = self.position.min(self.json.len());
    }

    /// A number, `true`, `false` or `null`.
    fn skip_word(&mut self) {
        let ends = |byte: &u8| b",:]}[{\" \t\r\n".contains(byte);
        let rest = &self.json[self.position..];
        self.position += rest.iter().position(ends).unwrap_or(rest.len()).max(1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(json: &str) -> Vec<Option<&str>> {
        let spans = buffer_uri_spans(json.as_bytes());
        spans
            .into_iter()
            .map(|span| span.map(|span| &json[span]))
            .collect()
    }

    #[test]
    fn only_the_uri_of_a_buffer_is_found() {
        let json = r#" { "uri" : "no", "images": [{"uri": "no"}, [1, -2.5e3, true]],
            "buffers" : [ {"extras": {"uri": "no", "x": [{}]}, "uri" : "a\"]}b" , "byteLength":3},
            {"byteLength": 1}, {"\u0075ri": "c"} ], "z": {"buffers": [{"uri": "no"}]} } "#;
        assert_eq!(found(json), [Some(r#""a\"]}b""#), None, Some(r#""c""#)]);
    }

    #[test]
    fn the_last_of_two_fields_counts() {
        let json = r#"{"buffers":[{"uri":"a"},{}],"buffers":[{"uri":"b","uri":"c"}]}"#;
        assert_eq!(found(json), [Some(r#""c""#)]);
    }

    #[test]
    fn text_that_is_no_gltf_has_none() {
        for json in [
            "",
            "[]",
            "{}",
            "3",
            r#"{"buffers":3}"#,
            r#"{"buffers":{"uri":""}}"#,
        ] {
            assert_eq!(found(json), []);
        }
        assert_eq!(found(r#"{"buffers":[7,"x",[]]}"#), [None, None, None]);
        assert_eq!(found(r#"{"buffers":[{"uri":"\"#), [Some(r#""\"#)]);
    }
}
