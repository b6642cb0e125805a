//! Stores parameters: numbered ones, and names, local to a subroutine or global.
//!
//! Source: RS274/NGC and the manual of LinuxCNC: `#1` to `#30` and names are local to a subroutine,
//! names that begin with `_` are global. Not here: parameters that tell the state of the machine,
//! and which of the numbered ones are offsets.

use crate::error::arithmetic::ArithmeticError;
use std::collections::BTreeMap;

/// Largest number of a parameter.
pub(crate) const LARGEST_PARAMETER: u32 = 5602;

/// Parameters `#1` to this are local to a subroutine.
pub(crate) const LOCAL_PARAMETERS: usize = 30;

/// Number of the coordinate system in force: 1 unless it was set.
pub(crate) const SYSTEM: u32 = 5220;

/// Parameters from here to [`LAST_READ_ONLY`] tell where the machine is.
const FIRST_READ_ONLY: u32 = 5400;
const LAST_READ_ONLY: u32 = 5428;

/// Named parameters that are held at once: memory must not grow with a loop that makes names.
const MAX_NAMES: usize = 10_000;

/// Subroutines within subroutines.
pub(crate) const DEEPEST_CALL: usize = 100;

/// Reads the value of a parameter.
pub(crate) trait Values {
    /// A numbered parameter; `number` is legal.
    fn numbered(&self, number: u32) -> f64;
    /// A named parameter, in lower case; none when it was never set.
    fn named(&self, name: &str) -> Option<f64>;
}

/// The parameters that a program has set.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Parameters {
    /// By their number, as far as one was set.
    numbered: Vec<f64>,
    global: BTreeMap<Box<str>, f64>,
    /// One for the main program and one for each subroutine that is running.
    local: Vec<BTreeMap<Box<str>, f64>>,
    saved: Vec<[f64; LOCAL_PARAMETERS]>,
    names: usize,
}

impl Parameters {
    pub(crate) fn new() -> Self {
        Self {
            numbered: vec![0.0; LOCAL_PARAMETERS + 1],
            global: BTreeMap::new(),
            local: vec![BTreeMap::new()],
            saved: Vec::new(),
            names: 0,
        }
    }

    /// A numbered parameter, 0 unless it was set.
    pub(crate) fn get(&self, number: u32) -> f64 {
        let unset = f64::from(u8::from(number == SYSTEM));
        self.numbered.get(number as usize).copied().unwrap_or(unset)
    }

    /// Sets a numbered parameter on behalf of the reader.
    pub(crate) fn put(&mut self, number: u32, value: f64) {
        let index = number as usize;
        if number > LARGEST_PARAMETER {
            return;
        }
        if index >= self.numbered.len() {
            let before = self.get(SYSTEM);
            self.numbered.resize(index + 1, 0.0);
            if let Some(system) = self.numbered.get_mut(SYSTEM as usize) {
                *system = before;
            }
        }
        self.numbered[index] = value;
    }

    /// Sets a numbered parameter on behalf of the program.
    pub(crate) fn set(&mut self, number: u32, value: f64) -> Result<(), ArithmeticError> {
        if (FIRST_READ_ONLY..=LAST_READ_ONLY).contains(&number) {
            return Err(ArithmeticError::ReadOnly { number });
        }
        self.put(number, value);
        Ok(())
    }

    /// A named parameter.
    pub(crate) fn get_named(&self, name: &str) -> Option<f64> {
        let scope = if name.starts_with('_') {
            Some(&self.global)
        } else {
            self.local.last()
        };
        scope.and_then(|scope| scope.get(name)).copied()
    }

    /// Sets a named parameter.
    pub(crate) fn set_named(&mut self, name: &str, value: f64) -> Result<(), ArithmeticError> {
        let scope = if name.starts_with('_') {
            Some(&mut self.global)
        } else {
            self.local.last_mut()
        };
        let Some(scope) = scope else { return Ok(()) };
        if let Some(place) = scope.get_mut(name) {
            *place = value;
            return Ok(());
        }
        if self.names >= MAX_NAMES {
            return Err(ArithmeticError::TooMany { bound: MAX_NAMES });
        }
        self.names += 1;
        scope.insert(name.into(), value);
        Ok(())
    }

    /// Begins a subroutine with its arguments in `#1`, `#2` and so on; the others of the local ones
    /// are 0.
    pub(crate) fn enter(&mut self, arguments: &[f64]) {
        let mut own = [0.0; LOCAL_PARAMETERS];
        for (place, argument) in own.iter_mut().zip(arguments) {
            *place = *argument;
        }
        let locals = &mut self.numbered[1..=LOCAL_PARAMETERS];
        let mut saved = [0.0; LOCAL_PARAMETERS];
        saved.copy_from_slice(locals);
        locals.copy_from_slice(&own);
        self.saved.push(saved);
        self.local.push(BTreeMap::new());
    }

    /// Ends a subroutine.
    pub(crate) fn leave(&mut self) {
        if let Some(saved) = self.saved.pop() {
            self.numbered[1..=LOCAL_PARAMETERS].copy_from_slice(&saved);
            if let Some(scope) = self.local.pop() {
                self.names -= scope.len();
            }
        }
    }
}

impl Values for Parameters {
    fn numbered(&self, number: u32) -> f64 {
        self.get(number)
    }

    fn named(&self, name: &str) -> Option<f64> {
        self.get_named(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[allow(clippy::float_cmp, reason = "values are stored, not computed")]
    fn a_subroutine_has_its_own_local_parameters_and_names() {
        let mut parameters = Parameters::new();
        parameters.put(1, 7.0);
        parameters.put(31, 5.0);
        parameters.set_named("depth", 2.0).unwrap();
        parameters.set_named("_depth", 3.0).unwrap();
        parameters.enter(&[1.5]);
        let seen = [1, 2, 31].map(|number| parameters.get(number));
        assert_eq!(seen, [1.5, 0.0, 5.0], "numbered");
        assert_eq!(parameters.get_named("depth"), None, "local name");
        assert_eq!(parameters.get_named("_depth"), Some(3.0), "global name");
        parameters.put(1, 9.0);
        parameters.leave();
        assert_eq!(parameters.get(1), 7.0, "restored");
        assert_eq!(parameters.get_named("depth"), Some(2.0), "restored name");
    }

    #[test]
    fn where_the_machine_is_cannot_be_set() {
        let refused = Parameters::new().set(5420, 1.0);
        let number = 5420;
        assert_eq!(refused, Err(ArithmeticError::ReadOnly { number }), "5420");
    }

    #[test]
    fn the_number_of_names_is_bounded() {
        let mut parameters = Parameters::new();
        for name in 0..MAX_NAMES {
            assert!(parameters.set_named(&name.to_string(), 0.0).is_ok(), "room");
        }
        let bound = MAX_NAMES;
        let refused = parameters.set_named("one more", 0.0);
        assert_eq!(refused, Err(ArithmeticError::TooMany { bound }), "full");
    }
}
