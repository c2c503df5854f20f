//! From the tables of events to [`Event`].

use toml::Spanned;

use crate::behaviour::event::Event;
use crate::scenario::file::behaviour::names::Resolving;
use crate::scenario::file::behaviour::placed_fault::{At, PlacedFault, fault};
use crate::scenario::file::behaviour::tables::EventTable;

impl Resolving<'_> {
    /// One event.
    pub(crate) fn event(&mut self, name: &str, table: &Spanned<EventTable>) -> Result<Event, PlacedFault> {
        let (span, event) = (table.span(), table.get_ref());
        let condition = self.condition(&event.when).at(&span)?;
        if !condition.is_of_crowd() {
            let message = format!("`when` of event `{name}` speaks of one agent");
            return Err(fault(
                &span,
                message,
                "use `after_s`, `green`, `number`, `population`, `all`, `any` and `not`",
            ));
        }
        if event.to.is_none() && event.signals.is_empty() {
            let message = format!("event `{name}` changes nothing");
            return Err(fault(&span, message, "add `to = \"STATE\"` or `signals = { NAME = \"green\" }`"));
        }
        let from = event.from.as_ref().map(|from| {
            let states = from.get_ref().iter().map(|state| self.state_index(state));
            states.collect::<Result<Vec<u32>, _>>().at(&from.span())
        });
        let to = event.to.as_ref().map(|to| self.state_index(to.get_ref()).at(&to.span()));
        let signals = event.signals.iter().map(|(signal, &order)| Ok((self.signals.index(signal)?, order)));
        Ok(Event {
            name: name.to_owned(),
            condition,
            from: from.transpose()?,
            to: to.transpose()?,
            signals: signals.collect::<Result<_, _>>().at(&span)?,
        })
    }
}
