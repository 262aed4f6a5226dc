//! Names and classes of outlines.

use super::Pictures;
use crate::LiveError;

/// Characters that a name may have.
const MOST: usize = 200;

impl Pictures {
    /// Give an outline a name and a class.
    pub(super) fn name(&mut self, id: u32, label: &str, class: &str) -> Result<(), LiveError> {
        for words in [label, class] {
            let count = words.chars().count();
            if count > MOST {
                return Err(LiveError::new(format!(
                    "a name must have at most {MOST} characters, got {count}"
                )));
            }
            if words.chars().any(char::is_control) {
                return Err(LiveError::new("a name must be one line of text"));
            }
        }
        let one = self.one_mut(id)?;
        label.trim().clone_into(&mut one.label);
        class.trim().clone_into(&mut one.class);
        if one.label.is_empty() {
            one.label = format!("outline {id}");
        }
        Ok(())
    }
}
