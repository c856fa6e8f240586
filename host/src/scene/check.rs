//! Checks that scene files have in common: numbers in range, in lists of the right length.
use std::ops::RangeInclusive;

use toml::Spanned;

use super::error::InputError;
use super::source::SourceText;
use crate::vector::length;

/// Checks values against the text that they come from, which errors show.
pub(super) struct Check<'a> {
    pub(super) source: &'a SourceText,
}

impl Check<'_> {
    /// Three finite numbers.
    pub(super) fn triple(&self, what: &str, list: &Spanned<Vec<f64>>) -> Result<[f64; 3], InputError> {
        let Ok(triple) = <[f64; 3]>::try_from(list.get_ref().as_slice()) else {
            let found = list.get_ref().len();
            return Err(self.source.refuse(
                list.span(),
                format!("{what} has {found} numbers"),
                "three are expected",
                "write three numbers, such as `[0, 0, 1]`",
            ));
        };
        if triple.iter().all(|number| number.is_finite()) {
            return Ok(triple);
        }
        Err(self.source.refuse(
            list.span(),
            format!("{what} holds NaN, infinity or a number above 1.7e308"),
            "not finite",
            "write three finite numbers",
        ))
    }

    /// Three finite numbers whose length is finite too.
    pub(super) fn vector(&self, what: &str, list: &Spanned<Vec<f64>>) -> Result<[f64; 3], InputError> {
        let vector = self.triple(what, list)?;
        if length(vector).is_finite() {
            return Ok(vector);
        }
        let help = "write smaller numbers";
        Err(self.source.refuse(list.span(), format!("{what} is too long"), "longer than 1.7e308", help))
    }

    /// Red, green and blue, each 0 to 1.
    pub(super) fn colour(&self, what: &str, list: &Spanned<Vec<f64>>) -> Result<[f64; 3], InputError> {
        let colour = self.triple(what, list)?;
        if colour.iter().all(|part| (0.0..=1.0).contains(part)) {
            return Ok(colour);
        }
        Err(self.source.refuse(
            list.span(),
            format!("{what} is not a colour"),
            "not from 0 to 1",
            "write red, green and blue, each from 0 to 1",
        ))
    }

    /// A finite number.
    pub(super) fn finite(&self, what: &str, number: &Spanned<f64>) -> Result<f64, InputError> {
        let value = *number.get_ref();
        if value.is_finite() {
            return Ok(value);
        }
        let help = "write a finite number";
        Err(self.source.refuse(number.span(), format!("{what} is {value}"), "not finite", help))
    }

    /// A finite number of at least 0.
    pub(super) fn amount(&self, what: &str, number: &Spanned<f64>) -> Result<f64, InputError> {
        let value = *number.get_ref();
        if value >= 0.0 && value.is_finite() {
            return Ok(value);
        }
        let help = "write a finite number of at least 0";
        Err(self.source.refuse(number.span(), format!("{what} is {value}"), "out of range", help))
    }

    /// A finite number above 0.
    pub(super) fn positive(&self, what: &str, number: &Spanned<f64>) -> Result<f64, InputError> {
        let value = *number.get_ref();
        if value > 0.0 && value.is_finite() {
            return Ok(value);
        }
        let help = "write a finite number above 0";
        Err(self.source.refuse(number.span(), format!("{what} is {value}"), "out of range", help))
    }

    /// A number from 0 to 1.
    pub(super) fn part(&self, what: &str, number: &Spanned<f64>) -> Result<f64, InputError> {
        let value = *number.get_ref();
        if (0.0..=1.0).contains(&value) {
            return Ok(value);
        }
        let help = "write a number from 0 to 1";
        Err(self.source.refuse(number.span(), format!("{what} is {value}"), "out of range", help))
    }

    /// A number between 0 and 1, neither of them.
    pub(super) fn share(&self, what: &str, number: &Spanned<f64>) -> Result<f64, InputError> {
        let value = *number.get_ref();
        if value > 0.0 && value < 1.0 {
            return Ok(value);
        }
        let help = "write a number above 0 and below 1";
        Err(self.source.refuse(number.span(), format!("{what} is {value}"), "out of range", help))
    }

    /// A whole number in `range`. It is read as one of far more digits, so that whatever is written is told this range.
    pub(super) fn whole(
        &self,
        what: &str,
        number: &Spanned<i128>,
        range: RangeInclusive<u32>,
    ) -> Result<u32, InputError> {
        let value = *number.get_ref();
        let (least, most) = (*range.start(), *range.end());
        match u32::try_from(value) {
            Ok(whole) if range.contains(&whole) => Ok(whole),
            _ => Err(self.source.refuse(
                number.span(),
                format!("{what} is {value}"),
                if value < least.into() { "too small" } else { "too large" },
                format!("write a whole number from {least} to {most}"),
            )),
        }
    }
}
