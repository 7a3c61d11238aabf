//! What JavaScript calls. A request is written into memory that `hamel_room` reserves; `hamel_answer` reads it, and the
//! answer lies where `hamel_said` points to until the next request, and numbers that belong to it where `hamel_numbers` does.
//!
//! Nothing here is unsafe but for the names of the exports, which nothing else may have: no pointer is read from.

#![allow(unsafe_code)]

use std::cell::RefCell;

thread_local! {
    static REQUEST: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static ANSWER: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static NUMBERS: RefCell<Vec<f32>> = const { RefCell::new(Vec::new()) };
}

/// Makes room for a request of as many bytes, and says where it is.
#[unsafe(no_mangle)]
pub extern "C" fn hamel_room(bytes: usize) -> *mut u8 {
    REQUEST.with_borrow_mut(|request| {
        request.clear();
        request.resize(bytes, 0);
        request.as_mut_ptr()
    })
}

/// Answers the request; how many bytes the answer has.
#[unsafe(no_mangle)]
pub extern "C" fn hamel_answer() -> usize {
    let request = REQUEST.take();
    let (answer, numbers) = crate::answer(&String::from_utf8_lossy(&request));
    let length = answer.len();
    ANSWER.replace(answer.into_bytes());
    NUMBERS.replace(numbers);
    length
}

/// Where the answer is.
#[unsafe(no_mangle)]
pub extern "C" fn hamel_said() -> *const u8 {
    ANSWER.with_borrow(|answer| answer.as_ptr())
}

/// How many numbers belong to the answer.
#[unsafe(no_mangle)]
pub extern "C" fn hamel_count() -> usize {
    NUMBERS.with_borrow(Vec::len)
}

/// Where these numbers are.
#[unsafe(no_mangle)]
pub extern "C" fn hamel_numbers() -> *const f32 {
    NUMBERS.with_borrow(|numbers| numbers.as_ptr())
}
