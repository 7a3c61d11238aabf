//! Robots of Pinocchio, through the functions of `reader.cpp` and `driver.cpp`.

use crate::measure::INPUTS;
use crate::robots::Robot;
use libloading::{Library, Symbol};
use std::error::Error;
use std::ffi::{CString, c_char, c_int, c_void};
use std::hint::black_box;
use std::path::Path;

type Read =
    unsafe extern "C" fn(*const c_char, c_int, *const *const c_char, *const c_char) -> *mut c_void;
type Open = unsafe extern "C" fn(*const c_void) -> *mut c_void;
type Close = unsafe extern "C" fn(*mut c_void);
type Size = unsafe extern "C" fn(*const c_void) -> c_int;
type Add = unsafe extern "C" fn(*mut c_void, *const f64, *const f64, *const f64, *const f64);
type Call = unsafe extern "C" fn(*mut c_void, usize) -> *const f64;
type Last = unsafe extern "C" fn(*const c_void) -> *const f64;
type Parameters = unsafe extern "C" fn(*const c_void, *mut f64);

/// A description of a robot as read from its file.
pub struct Description<'a> {
    library: &'a Library,
    description: *mut c_void,
}

impl<'a> Description<'a> {
    /// Reads a robot from a file below the folder.
    pub fn read(
        library: &'a Library,
        folder: &Path,
        robot: &Robot,
    ) -> Result<Self, Box<dyn Error>> {
        let file = folder.join(robot.urdf);
        let urdf = CString::new(file.as_os_str().as_encoded_bytes())?;
        let link = CString::new(robot.link)?;
        let locked = robot.locked.iter().map(|&joint| CString::new(joint));
        let locked: Vec<CString> = locked.collect::<Result<_, _>>()?;
        let pointers = locked.iter().map(|joint| joint.as_ptr());
        let pointers: Vec<_> = pointers.chain([std::ptr::null()]).collect();
        // SAFETY: the signature is that of the reader; strings end with 0, and their list with a null pointer.
        let description = unsafe {
            library.get::<Read>(b"pin_read")?(
                urdf.as_ptr(),
                robot.floating.into(),
                pointers.as_ptr(),
                link.as_ptr(),
            )
        };
        if description.is_null() {
            return Err(format!("Pinocchio does not read {}", file.display()).into());
        }
        Ok(Description {
            library,
            description,
        })
    }
}

impl Drop for Description<'_> {
    fn drop(&mut self) {
        // SAFETY: the signature is that of the reader, and the description is not used afterwards.
        unsafe {
            if let Ok(forget) = self.library.get::<Close>(b"pin_forget") {
                forget(self.description);
            }
        }
    }
}

/// A robot with the states at which its functions are called.
pub struct Peer<'a> {
    library: &'a Library,
    robot: *mut c_void,
    states: usize,
}

impl<'a> Peer<'a> {
    /// Creates the robot of a description.
    pub fn open(library: &'a Library, from: &Description<'_>) -> Result<Self, Box<dyn Error>> {
        // SAFETY: the signature is that of the driver, which copies what it needs from the description.
        let robot = unsafe { library.get::<Open>(b"pin_open")?(from.description) };
        if robot.is_null() {
            return Err("Pinocchio does not build the robot".into());
        }
        Ok(Peer {
            library,
            robot,
            states: 0,
        })
    }

    /// Returns `pin_nq`, `pin_nv` or `pin_bodies`.
    pub fn size(&self, name: &str) -> Result<usize, Box<dyn Error>> {
        // SAFETY: the signature is that of the driver, and the robot is open.
        let size = unsafe { self.library.get::<Size>(name.as_bytes())?(self.robot) };
        Ok(size.try_into()?)
    }

    /// Adds a state: configuration, velocity, acceleration, force.
    pub fn add(&mut self, state: [&[f64]; 4]) -> Result<(), Box<dyn Error>> {
        let [nq, nv] = [self.size("pin_nq")?, self.size("pin_nv")?];
        let lengths = state.map(<[f64]>::len);
        if lengths != [nq, nv, nv, nv] {
            return Err(format!("a state of {lengths:?} numbers, {nq} and {nv} wanted").into());
        }
        let [q, v, a, tau] = state.map(<[f64]>::as_ptr);
        // SAFETY: the signature is that of the driver, and the lengths are those of the robot.
        unsafe { self.library.get::<Add>(b"pin_add")?(self.robot, q, v, a, tau) };
        self.states += 1;
        Ok(())
    }

    /// Returns a function that can be called at the states.
    pub fn function(&self, name: &str) -> Result<Function<'_>, Box<dyn Error>> {
        if self.states != INPUTS {
            return Err(format!("{} states, {INPUTS} wanted", self.states).into());
        }
        // SAFETY: the signature is common to all functions of the driver that take a state.
        let call = unsafe { self.library.get::<Call>(name.as_bytes())? };
        Ok(Function {
            robot: self.robot,
            call,
        })
    }

    /// Returns `length` numbers from a matrix that the last call left.
    pub fn last(&self, name: &str, length: usize) -> Result<Vec<f64>, Box<dyn Error>> {
        // SAFETY: the signature is that of the driver, whose matrix has `length` entries.
        let values = unsafe {
            let first = self.library.get::<Last>(name.as_bytes())?(self.robot);
            std::slice::from_raw_parts(first, length)
        };
        Ok(values.to_vec())
    }

    /// Returns the ten inertial parameters of every body.
    pub fn parameters(&self) -> Result<Vec<f64>, Box<dyn Error>> {
        let mut parameters = vec![0.0; 10 * self.size("pin_bodies")?];
        // SAFETY: the signature is that of the driver, and the list is as long as it writes.
        unsafe {
            self.library.get::<Parameters>(b"pin_parameters")?(self.robot, parameters.as_mut_ptr());
        }
        Ok(parameters)
    }
}

impl Drop for Peer<'_> {
    fn drop(&mut self) {
        // SAFETY: the signature is that of the driver, and the robot is not used afterwards.
        unsafe {
            if let Ok(close) = self.library.get::<Close>(b"pin_close") {
                close(self.robot);
            }
        }
    }
}

/// A function of a robot.
pub struct Function<'a> {
    robot: *mut c_void,
    call: Symbol<'a, Call>,
}

impl Function<'_> {
    /// Returns the first `length` numbers of its value at state k.
    pub fn value(&self, k: usize, length: usize) -> Vec<f64> {
        assert!(k < INPUTS, "{k}: no such state");
        // SAFETY: the robot is open and has that state; its value has at least `length` numbers.
        unsafe { std::slice::from_raw_parts((self.call)(self.robot, k), length) }.to_vec()
    }

    /// Evaluates all states `count` times.
    pub fn run(&self, count: u32) {
        let call = black_box(*self.call);
        for _ in 0..count {
            for k in 0..INPUTS {
                // SAFETY: the robot is open and has these states.
                black_box(unsafe { call(self.robot, k) });
            }
        }
    }
}
