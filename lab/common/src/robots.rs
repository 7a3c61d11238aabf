//! The robots, for the build script and for the program.

/// A robot of the wheel `example-robot-data`.
pub struct Robot {
    /// Its file below the folder of the robots.
    pub urdf: &'static str,
    /// Whether its base moves freely.
    pub floating: bool,
    /// Joints that stay at 0.
    pub locked: &'static [&'static str],
    /// The link whose Jacobian is taken.
    pub link: &'static str,
}

pub const UR5: Robot = Robot {
    urdf: "ur_description/urdf/ur5_robot.urdf",
    floating: false,
    locked: &[],
    link: "wrist_3_link",
};

/// The arm with its fingers closed.
pub const PANDA: Robot = Robot {
    urdf: "panda_description/urdf/panda.urdf",
    floating: false,
    locked: &["panda_finger_joint1", "panda_finger_joint2"],
    link: "panda_link7",
};

pub const SOLO12: Robot = Robot {
    urdf: "solo_description/robots/solo12.urdf",
    floating: true,
    locked: &[],
    link: "FL_FOOT",
};
