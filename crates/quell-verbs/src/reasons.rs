//! Why a part of an answer has no value, as enums: reasons that an engine gives, and sentences of the verb itself.

/// An enum of reasons. First come those of others, each with its conversion, and with a sentence around it if one is given; after the
/// semicolon those that are sentences.
macro_rules! reasons {
    (
        $(#[$about:meta])*
        $visibility:vis enum $name:ident {
            $($(#[$of:meta])* $passed:ident($reason:ty) $(=> $around:literal)?,)*
            ;
            $($(#[$what:meta])* $said:ident => $words:expr,)*
        }
    ) => {
        $(#[$about])*
        #[derive(Clone, Debug, PartialEq)]
        $visibility enum $name {
            $($(#[$of])* $passed($reason),)*
            $($(#[$what])* $said,)*
        }

        quell_design::passed_on! { $name: $($passed($reason)),* }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                match self {
                    $(Self::$passed(why) => write!(f, $crate::reasons::reasons!(@around $($around)?), why),)*
                    $(Self::$said => f.write_str($words),)*
                }
            }
        }

        impl std::error::Error for $name {}
    };
    (@around) => { "{}" };
    (@around $around:literal) => { $around };
}

pub(crate) use reasons;
