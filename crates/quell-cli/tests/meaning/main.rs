//! What the answers mean, through every verb: the same equations written twice have one answer, and no answer of a study of the
//! repository changes unnoticed.

mod answer;
mod disc;
mod mass;
mod snapshot;
mod twins;
