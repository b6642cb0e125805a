//! Keeps what happened until the controller asks for it.

/// Events kept at most; older ones are forgotten first.
const MAX_EVENTS: usize = 256;

/// Something that happened between two ticks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// Motion came to a move, counted from 0 in path order; forwards or backwards.
    Entered {
        /// The move.
        block: u32,
        /// Whether the motion goes backwards.
        reverse: bool,
    },
    /// Motion left a move.
    Left {
        /// The move.
        block: u32,
        /// Whether the motion goes backwards.
        reverse: bool,
    },
    /// The motion came to rest after a hold.
    Held,
    /// The motion goes on.
    Resumed,
    /// The known motion ends at speed and is too short to go on; it is held until more is fed.
    Starved,
    /// The motion came to rest at the end of a block.
    AtBlockEnd {
        /// The move.
        block: u32,
    },
    /// Everything in hand was dropped.
    Aborted {
        /// The move that was executed last.
        block: u32,
    },
}

/// The last events, oldest first.
#[derive(Clone, Debug)]
pub(crate) struct Events {
    ring: [Option<Event>; MAX_EVENTS],
    first: usize,
    count: usize,
}

impl Events {
    pub(crate) fn new() -> Self {
        Self {
            ring: [None; MAX_EVENTS],
            first: 0,
            count: 0,
        }
    }

    pub(crate) fn push(&mut self, event: Event) {
        let place = (self.first + self.count) % MAX_EVENTS;
        self.ring[place] = Some(event);
        if self.count < MAX_EVENTS {
            self.count += 1;
        } else {
            self.first = (self.first + 1) % MAX_EVENTS;
        }
    }

    pub(crate) fn pop(&mut self) -> Option<Event> {
        if self.count == 0 {
            return None;
        }
        let event = self.ring[self.first];
        self.first = (self.first + 1) % MAX_EVENTS;
        self.count -= 1;
        event
    }
}
