//! HTML pages: head, table of contents, sections, tables, and text with symbols. Reports are made with it.

use std::fmt::Write as _;

/// A page with sections and a table of contents.
#[derive(Clone, Debug)]
pub struct HtmlPage {
    title: String,
    style: &'static str,
    contents: String,
    body: String,
    /// What closes the present section.
    open: &'static str,
}

impl HtmlPage {
    /// An empty page with this title and style sheet.
    pub fn new(title: &str, style: &'static str) -> Self {
        Self { title: escape(title), style, contents: String::new(), body: String::new(), open: "" }
    }

    /// Adds HTML.
    pub fn put(&mut self, html: &str) {
        self.body += html;
        self.body.push('\n');
    }

    /// Begins a section with a line in the table of contents.
    pub fn section(&mut self, anchor: &str, title: &str) {
        let title = self.begun(anchor, title, "</section>");
        self.put(&format!("<section id=\"{anchor}\"><h2>{title}</h2>"));
    }

    /// Begins a section of which only the title is shown until it is opened.
    pub fn folded(&mut self, anchor: &str, title: &str) {
        let title = self.begun(anchor, title, "</details></section>");
        self.put(&format!("<section id=\"{anchor}\"><details><summary><h2>{title}</h2></summary>"));
    }

    fn begun(&mut self, anchor: &str, title: &str, close: &'static str) -> String {
        self.close();
        self.open = close;
        let title = escape(title);
        let _ = writeln!(self.contents, "<a class=\"part\" href=\"#{anchor}\">{title}</a>");
        title
    }

    /// A line in the table of contents below the section.
    pub fn entry(&mut self, anchor: &str, number: &str, title: &str) {
        let _ = writeln!(
            self.contents,
            "<a href=\"#{anchor}\"><span>{}</span>{}</a>",
            escape(number),
            escape(title)
        );
    }

    fn close(&mut self) {
        let close = std::mem::take(&mut self.open);
        if !close.is_empty() {
            self.put(close);
        }
    }

    /// The whole page.
    pub fn finish(mut self) -> String {
        self.close();
        let Self { title, style, contents, body, .. } = self;
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <title>{title}</title>\n<style>\n{style}</style>\n</head>\n<body>\n\
             <nav aria-label=\"Contents\"><a class=\"top\" href=\"#top\">{title}</a>\n{contents}</nav>\n\
             <main id=\"top\">\n{body}</main>\n</body>\n</html>\n"
        )
    }
}

/// Text as HTML.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A sentence with symbols as HTML: subscripts and superscripts as in `v_m`, `α^L`, `e^{γ−w}`, and minus signs before numbers.
pub fn symbols(text: &str) -> String {
    let letters: Vec<char> = text.chars().collect();
    let mut html = String::new();
    let mut at = 0;
    while at < letters.len() {
        let before = at.checked_sub(1).map(|before| letters[before]);
        let next = letters.get(at + 1).copied();
        let mark = match letters[at] {
            '_' if is_symbol(&letters[..at]) => Some("sub"),
            '^' => Some("sup"),
            _ => None,
        };
        let inner = mark.map(|_| group(&letters[at + 1..])).filter(|(inner, _)| !inner.is_empty());
        if let (Some(mark), Some((inner, length))) = (mark, inner) {
            let _ = write!(html, "<{mark}>{}</{mark}>", escape(&inner));
            at += 1 + length;
            continue;
        }
        let negative = letters[at] == '-'
            && next.is_some_and(|next| next.is_ascii_digit())
            && before.is_none_or(|before| !before.is_alphanumeric() || before == 'e');
        html += &if negative { "−".to_owned() } else { escape(&letters[at].to_string()) };
        at += 1;
    }
    html
}

/// Whether a text ends with a symbol of one letter, and not with a key such as `belt_velocity`.
fn is_symbol(text: &[char]) -> bool {
    let in_key = |letter: &char| letter.is_alphabetic() || matches!(letter, '_' | '.');
    match text {
        [.., before, last] => last.is_alphabetic() && !in_key(before),
        [last] => last.is_alphabetic(),
        [] => false,
    }
}

/// The text of a subscript or superscript, `{…}` or the letters and digits of one word, and its length in characters.
fn group(letters: &[char]) -> (String, usize) {
    if letters.first() == Some(&'{') {
        let end = letters.iter().position(|letter| *letter == '}').unwrap_or(letters.len());
        return (letters[1..end].iter().collect(), (end + 1).min(letters.len()));
    }
    let count = letters.iter().take_while(|letter| letter.is_ascii_alphanumeric()).count();
    (letters[..count].iter().collect(), count)
}

/// A table with the given column names and rows of HTML cells.
pub fn table(class: &str, names: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let head =
        names.iter().map(|name| format!("<th>{name}</th>")).collect::<Vec<String>>().concat();
    let body = rows
        .into_iter()
        .map(|cells| {
            let cells = cells
                .iter()
                .map(|cell| format!("<td>{cell}</td>"))
                .collect::<Vec<String>>()
                .concat();
            format!("<tr>{cells}</tr>\n")
        })
        .collect::<Vec<String>>()
        .concat();
    format!(
        "<div class=\"wide\"><table class=\"{class}\"><thead><tr>{head}</tr></thead><tbody>\n{body}</tbody></table></div>"
    )
}

#[cfg(test)]
mod tests {
    use super::symbols;

    #[test]
    fn symbols_become_subscripts_and_superscripts() {
        assert_eq!(symbols("v_mζ < Ω_1"), "v<sub>m</sub>ζ &lt; Ω<sub>1</sub>");
        assert_eq!(symbols("α^L, e^{γ−w}"), "α<sup>L</sup>, e<sup>γ−w</sup>");
        assert_eq!(symbols("Ω + 2Ω_1"), "Ω + 2Ω<sub>1</sub>");
        assert_eq!(symbols("belt.belt_velocity_m_per_s"), "belt.belt_velocity_m_per_s");
        assert_eq!(symbols("-0.5, 5.9-5.12, 2e-7"), "−0.5, 5.9-5.12, 2e−7");
    }
}
