//! Functions exported to JavaScript, which writes a request to memory reserved by `hamel_room`, then calls
//! `hamel_answer`. The answer is at `hamel_said`, its numbers are at `hamel_numbers`, until the next request.
//!
//! Only the unmangled names of the exports, which must be unique, require `unsafe`; no pointer is dereferenced.

#![allow(unsafe_code)]

use std::cell::RefCell;

thread_local! {
    static REQUEST: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static ANSWER: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static NUMBERS: RefCell<Vec<f32>> = const { RefCell::new(Vec::new()) };
}

/// Reserves memory for a request, and returns its address.
#[unsafe(no_mangle)]
pub extern "C" fn hamel_room(bytes: usize) -> *mut u8 {
    REQUEST.with_borrow_mut(|request| {
        request.clear();
        request.resize(bytes, 0);
        request.as_mut_ptr()
    })
}

/// Answers the request, and returns the length of the answer in bytes.
#[unsafe(no_mangle)]
pub extern "C" fn hamel_answer() -> usize {
    let request = REQUEST.take();
    let (answer, numbers) = crate::answer(&String::from_utf8_lossy(&request));
    let length = answer.len();
    ANSWER.replace(answer.into_bytes());
    NUMBERS.replace(numbers);
    length
}

/// Returns the address of the answer.
#[unsafe(no_mangle)]
pub extern "C" fn hamel_said() -> *const u8 {
    ANSWER.with_borrow(|answer| answer.as_ptr())
}

/// Returns the number of numbers of the answer.
#[unsafe(no_mangle)]
pub extern "C" fn hamel_count() -> usize {
    NUMBERS.with_borrow(Vec::len)
}

/// Returns the address of these numbers.
#[unsafe(no_mangle)]
pub extern "C" fn hamel_numbers() -> *const f32 {
    NUMBERS.with_borrow(|numbers| numbers.as_ptr())
}
