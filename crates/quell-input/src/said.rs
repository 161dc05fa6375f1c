//! Texts for every door: what the command line and Python spell differently is named by a type, and the door spells it.

use std::fmt;
use std::ops::{Deref, Range};

/// Something that the doors spell differently.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Mention {
    /// A verb as it is called, with an option that makes it another one: `stability --exact`.
    Verb(String),
    /// The same request, made again.
    SameRequest,
    /// The argument with which a stored map is continued.
    Resume,
    /// The argument with which a map is stored.
    Store,
    /// How a map is given the values of the amplitude of a dither without a table in its study.
    ValuesOfAmplitude,
    /// The list of the keys of a study.
    Schema,
    /// The verb `stability`, to be called.
    Stability,
    /// A map of growth rates, to be called.
    MapOfGrowth,
}

/// On the command line.
impl fmt::Display for Mention {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Verb(name) => name,
            Self::SameRequest => "the same command",
            Self::Resume => "--resume",
            Self::Store => "--save FILE.zarr",
            Self::ValuesOfAmplitude => {
                "on the command line: --set sweep[0].parameter=dither.amplitude --set 'sweep[0].values=[0.1, 0.2]'"
            }
            Self::Schema => "`quell schema`",
            Self::Stability => "`quell stability`",
            Self::MapOfGrowth => "`quell map --quantity growth`",
        })
    }
}

/// A text with mentions. It reads as on the command line; another door takes [`Said::spelled`].
#[derive(Clone, Debug, Default)]
pub struct Said {
    text: String,
    mentions: Vec<(Range<usize>, Mention)>,
}

impl Said {
    /// The text and a further one.
    #[must_use]
    pub fn text(mut self, further: impl AsRef<str>) -> Self {
        self.text.push_str(further.as_ref());
        self
    }

    /// The text and a mention.
    #[must_use]
    pub fn mention(mut self, mention: Mention) -> Self {
        let begin = self.text.len();
        self.text.push_str(&mention.to_string());
        self.mentions.push((begin..self.text.len(), mention));
        self
    }

    /// The text as a door spells its mentions and what is between them.
    pub fn spelled(
        &self,
        mention: impl Fn(&Mention) -> String,
        between: impl Fn(&str) -> String,
    ) -> String {
        let (mut spelled, mut from) = (String::new(), 0);
        for (place, mentioned) in &self.mentions {
            spelled += &between(&self.text[from..place.start]);
            spelled += &mention(mentioned);
            from = place.end;
        }
        spelled + &between(&self.text[from..])
    }
}

/// Texts are equal that read alike.
impl PartialEq for Said {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

impl<T: AsRef<str> + ?Sized> PartialEq<T> for Said {
    fn eq(&self, other: &T) -> bool {
        self.text == other.as_ref()
    }
}

impl From<String> for Said {
    fn from(text: String) -> Self {
        Self { text, mentions: Vec::new() }
    }
}

impl From<&String> for Said {
    fn from(text: &String) -> Self {
        text.clone().into()
    }
}

impl From<&str> for Said {
    fn from(text: &str) -> Self {
        text.to_owned().into()
    }
}

impl From<Said> for String {
    fn from(said: Said) -> Self {
        said.text
    }
}

impl Deref for Said {
    type Target = str;

    fn deref(&self) -> &str {
        &self.text
    }
}

impl fmt::Display for Said {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_door_spells_mentions_and_the_text_between_them() {
        let said = Said::from("kept: ").mention(Mention::SameRequest).text(" with ");
        let said = said.mention(Mention::Resume).text(" continues");
        assert_eq!(&*said, "kept: the same command with --resume continues");
        let mention = |mention: &Mention| match mention {
            Mention::Resume => "resume=True".to_owned(),
            _ => "it".to_owned(),
        };
        let spelled = said.spelled(mention, str::to_uppercase);
        assert_eq!(spelled, "KEPT: it WITH resume=True CONTINUES");
    }
}
