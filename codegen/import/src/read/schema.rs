//! The closed list of elements and attributes of URDF files, with the dialects of Drake, Gazebo, Bullet, MuJoCo and ROS:
//! those that are read, and those that do not affect the equations of motion. Anything that is not on the list causes a
//! warning.

use Element::{Apart, Read, Unless};

/// The role of an element in the equations of motion.
pub(super) enum Element {
    /// It is read; the level lists its contents.
    Read(&'static Level),
    /// It does not affect the equations, and neither do its contents.
    Apart,
    /// It changes the motion unless its value is one of these words; the text says what to do about it.
    Unless(&'static [&'static str], &'static str),
}

/// Attributes and child elements of an element.
pub(super) struct Level {
    /// Names of attributes.
    pub(super) attributes: &'static [&'static str],
    /// Child elements by name; a `*` at the end of a name matches any ending.
    pub(super) elements: &'static [(&'static [&'static str], Element)],
    /// Advice for attributes and elements that are not on the list.
    pub(super) help: &'static str,
}

impl Level {
    /// Finds an element by name.
    pub(super) fn find(&self, name: &str) -> Option<&'static Element> {
        let same = |listed: &&str| match listed.strip_suffix('*') {
            Some(start) => name.starts_with(start),
            None => *listed == name,
        };
        let mut elements = self.elements.iter();
        elements
            .find(|(names, _)| names.iter().any(&same))
            .map(|(_, element)| element)
    }

    /// Returns the names of all child elements on the list, without patterns.
    pub(super) fn names(&self) -> impl Iterator<Item = &'static str> {
        let names = self.elements.iter().flat_map(|(names, _)| names.iter());
        names.copied().filter(|name| !name.ends_with('*'))
    }
}

/// Advice for everything that is not on the list.
const ADD: &str = "if it changes the motion, add it to the description";
/// Advice for links on which gravity does not act.
const GRAVITY: &str =
    "`gravity` of a description acts on all bodies; add a `force` that balances it";
/// Advice for joints of a simulator that close loops.
const CLOSE: &str = "a joint that closes a loop is a `loop` in the description";
/// Words for yes and for no in Gazebo's files.
const YES: &[&str] = &["true", "1"];
const NO: &[&str] = &["false", "0"];

/// Makes the level of an element that has attributes and no child elements.
const fn leaf(attributes: &'static [&'static str], help: &'static str) -> Level {
    Level {
        attributes,
        elements: &[],
        help,
    }
}

const ORIGIN: Level = leaf(
    &["xyz", "rpy", "quat_xyzw"],
    "a pose is `<origin xyz=\"…\" rpy=\"…\"/>`",
);
const VALUE: Level = leaf(&["value"], ADD);
const NAME: Level = leaf(&["name"], ADD);
const LINK: Level = leaf(&["link"], ADD);
const AXIS: Level = leaf(&["xyz"], "a direction is `<axis xyz=\"…\"/>`");

/// `<robot>`.
pub(super) const ROBOT: Level = Level {
    attributes: &["name", "version"],
    elements: &[
        (&["link"], Read(&LINKS)),
        (&["joint", "drake:joint"], Read(&JOINT)),
        (&["transmission"], Read(&TRANSMISSION)),
        (&["gazebo"], Read(&GAZEBO)),
        (&["ros2_control"], Read(&CONTROL)),
        (&["mujoco"], Read(&MUJOCO)),
        (&["loop_joint"], Read(&LOOP)),
        (&["drake:ball_constraint"], Read(&BALL)),
        (
            &["drake:linear_bushing_rpy", "drake:tendon_constraint"],
            Unless(&[], ADD),
        ),
        (&["drake:linear_spring_damper"], Read(&SPRING)),
        (
            &["material", "sensor", "frame", "group", "group_state"],
            Apart,
        ),
        (
            &["chain", "end_effector", "virtual_joint", "passive_joint"],
            Apart,
        ),
        (
            &[
                "disable_collisions",
                "enable_collisions",
                "disable_default_collisions",
            ],
            Apart,
        ),
        (
            &["collision_filter_group", "drake:collision_filter_group"],
            Apart,
        ),
    ],
    help: ADD,
};

/// `<link>`.
const LINKS: Level = Level {
    attributes: &["name", "type"],
    elements: &[
        (&["inertial"], Read(&INERTIAL)),
        (&["contact"], Read(&CONTACT)),
        (
            &["visual", "collision", "sensor", "surface", "material"],
            Apart,
        ),
        (
            &[
                "collision_checking",
                "self_collision_checking",
                "self_filter",
            ],
            Apart,
        ),
        (
            &[
                "self_collide",
                "selfCollide",
                "laser_retro",
                "laserRetro",
                "audio_source",
            ],
            Apart,
        ),
        (&["gravity"], Unless(YES, GRAVITY)),
        (&["kinematic", "enable_wind", "static"], Unless(NO, ADD)),
        // Some exporters write a pose of the link in its own frame, the identity.
        (
            &["origin"],
            Unless(&["0 0 0"], "links have no pose: write it to the joint"),
        ),
    ],
    help: ADD,
};

const INERTIAL: Level = Level {
    attributes: &[],
    elements: &[
        (&["origin"], Read(&ORIGIN)),
        (&["mass"], Read(&VALUE)),
        (&["inertia"], Read(&INERTIA)),
    ],
    help: ADD,
};

const INERTIA: Level = leaf(&["ixx", "ixy", "ixz", "iyy", "iyz", "izz"], ADD);

/// `<contact>` of Bullet.
const CONTACT: Level = Level {
    attributes: &[],
    elements: &[
        (
            &[
                "lateral_friction",
                "rolling_friction",
                "spinning_friction",
                "friction_anchor",
            ],
            Apart,
        ),
        (
            &[
                "contact_cfm",
                "contact_erp",
                "stiffness",
                "damping",
                "restitution",
            ],
            Apart,
        ),
        (
            &["inertia_scaling"],
            Unless(&["1", "1.0"], "write the scaled inertia to `<inertia>`"),
        ),
    ],
    help: ADD,
};

/// `<joint>`.
const JOINT: Level = Level {
    attributes: &["name", "type", "dont_collapse"],
    elements: &[
        (&["parent", "child"], Read(&LINK)),
        (&["origin"], Read(&ORIGIN)),
        (&["axis"], Read(&AXIS)),
        (&["dynamics"], Read(&DYNAMICS)),
        (&["joint_properties"], Read(&PROPERTIES)),
        (&["limit"], Read(&LIMIT)),
        (&["mimic"], Read(&MIMIC)),
        (
            &[
                "calibration",
                "safety_controller",
                "hardwareInterface",
                "sensor",
            ],
            Apart,
        ),
    ],
    help: ADD,
};

const DYNAMICS: Level = leaf(
    &["damping", "friction", "armature"],
    "add it to the description",
);
const PROPERTIES: Level = leaf(&["damping", "friction"], "add it to the description");
const LIMIT: Level = leaf(
    &[
        "lower",
        "upper",
        "velocity",
        "effort",
        "effort_min",
        "effort_max",
        "acceleration",
        "deceleration",
        "jerk",
        "drake:acceleration",
    ],
    "add it to the description",
);
const MIMIC: Level = leaf(
    &["joint", "multiplier", "offset"],
    "it is `multiplier` · source + `offset`",
);

/// `<transmission>`: gear ratios alone change nothing; rotor inertias become armatures.
const TRANSMISSION: Level = Level {
    attributes: &["name", "type"],
    elements: &[
        (&["joint", "actuator"], Read(&DRIVE)),
        (
            &["leftActuator", "rightActuator", "flexJoint", "rollJoint"],
            Read(&PAIRED),
        ),
        (
            &[
                "type",
                "plugin",
                "role",
                "offset",
                "gap_joint",
                "passive_joint",
            ],
            Apart,
        ),
        (&["use_simulated_gripper_joint", "hardwareInterface"], Apart),
        (&RATIOS, Apart),
    ],
    help: ADD,
};

/// `<joint>` and `<actuator>` of a transmission.
const DRIVE: Level = Level {
    attributes: &["name", "role"],
    elements: &[
        (
            &["drake:controller_gains"],
            Unless(&[], "add the controller to the description as a `force`"),
        ),
        (&ROTORS, Read(&VALUE)),
        (&RATIOS, Apart),
        (
            &[
                "hardwareInterface",
                "hardware_interface",
                "role",
                "offset",
                "motorTorqueConstant",
            ],
            Apart,
        ),
        (
            &[
                "deadBandUpper",
                "deadBandLower",
                "saturationUpper",
                "saturationLower",
            ],
            Apart,
        ),
        (&["ignoreTransmissionAbsoluteEncoder"], Apart),
    ],
    help: ADD,
};

const PAIRED: Level = leaf(&["name", "mechanicalReduction"], ADD);

/// Elements for rotor inertias, Drake's name first.
pub(super) const ROTORS: [&str; 5] = [
    "drake:rotor_inertia",
    "rotor_inertia",
    "rotorInertia",
    "motorInertia",
    "motor_inertia",
];
/// Elements for gear ratios, Drake's name first.
pub(super) const RATIOS: [&str; 5] = [
    "drake:gear_ratio",
    "gear_ratio",
    "gearRatio",
    "mechanicalReduction",
    "mechanical_reduction",
];

/// `<ros2_control>`.
const CONTROL: Level = Level {
    attributes: &["name", "type", "rw_rate", "is_async", "thread_priority"],
    elements: &[
        (&["hardware", "joint", "sensor", "gpio"], Apart),
        (&["transmission"], Read(&TRANSMISSION)),
    ],
    help: ADD,
};

/// `<mujoco>`: settings of MuJoCo's compiler.
const MUJOCO: Level = Level {
    attributes: &["model"],
    elements: &[
        (&["compiler"], Read(&COMPILER)),
        (&["size", "visual", "statistic", "asset"], Apart),
    ],
    help: ADD,
};

const COMPILER: Level = leaf(
    &[
        "strippath",
        "meshdir",
        "texturedir",
        "assetdir",
        "discardvisual",
        "fusestatic",
        "autolimits",
        "angle",
        "convexhull",
        "alignfree",
    ],
    ADD,
);

/// `<gazebo>`: additions of Gazebo to a link, a joint or the robot.
const GAZEBO: Level = Level {
    attributes: &["reference"],
    elements: &[
        (&["springStiffness", "springReference"], Read(&VALUE)),
        (
            &[
                "material",
                "visual",
                "collision",
                "surface",
                "laserRetro",
                "laser_retro",
            ],
            Apart,
        ),
        (
            &["mu", "mu1", "mu2", "kp", "kd", "fdir1", "genTexCoord"],
            Apart,
        ),
        (
            &[
                "maxVel",
                "max_vel",
                "minDepth",
                "min_depth",
                "maxContacts",
                "max_contacts",
            ],
            Apart,
        ),
        (
            &[
                "selfCollide",
                "self_collide",
                "stopCfm",
                "stopErp",
                "stopKp",
                "stopKd",
            ],
            Apart,
        ),
        (
            &[
                "provideFeedback",
                "provide_feedback",
                "fudgeFactor",
                "cfmDamping",
            ],
            Apart,
        ),
        (
            &["implicitSpringDamper", "physics", "allow_auto_disable"],
            Apart,
        ),
        (
            &[
                "disableFixedJointLumping",
                "preserveFixedJoint",
                "canonicalBody",
            ],
            Apart,
        ),
        (
            &["initialJointPosition", "initial_joint_position", "pose"],
            Apart,
        ),
        (
            &[
                "sensor",
                "plugin",
                "audio_sink",
                "audio_source",
                "battery",
                "light",
                "projector",
            ],
            Apart,
        ),
        (
            &["controller:*", "sensor:*", "interface:*", "rendering:*"],
            Apart,
        ),
        (&["joint", "joint:*"], Unless(&[], CLOSE)),
        (
            &["link", "model", "include", "inertial", "gripper"],
            Unless(&[], ADD),
        ),
        (&["turnGravityOff"], Unless(NO, GRAVITY)),
        (&["gravity"], Unless(YES, GRAVITY)),
        (
            &["kinematic", "static", "setStaticFlag", "enable_wind"],
            Unless(NO, ADD),
        ),
        (
            &["dampingFactor"],
            Unless(&["0", "0.0"], "add a `force` in proportion to the velocity"),
        ),
    ],
    help: ADD,
};

/// `<loop_joint>`.
const LOOP: Level = Level {
    attributes: &["name", "type"],
    elements: &[(&["link1", "link2"], Read(&END)), (&["axis"], Read(&AXIS))],
    help: ADD,
};

const END: Level = leaf(&["link", "xyz", "rpy"], ADD);

const BALL: Level = Level {
    attributes: &[],
    elements: &[
        (
            &[
                "drake:ball_constraint_body_A",
                "drake:ball_constraint_body_B",
            ],
            Read(&NAME),
        ),
        (
            &["drake:ball_constraint_p_AP", "drake:ball_constraint_p_BQ"],
            Read(&VALUE),
        ),
    ],
    help: ADD,
};

const SPRING: Level = Level {
    attributes: &[],
    elements: &[
        (
            &[
                "drake:linear_spring_damper_body_A",
                "drake:linear_spring_damper_body_B",
            ],
            Read(&NAME),
        ),
        (
            &[
                "drake:linear_spring_damper_p_AP",
                "drake:linear_spring_damper_p_BQ",
            ],
            Read(&VALUE),
        ),
        (&["drake:linear_spring_damper_free_length"], Read(&VALUE)),
        (&["drake:linear_spring_damper_stiffness"], Read(&VALUE)),
        (&["drake:linear_spring_damper_damping"], Read(&VALUE)),
    ],
    help: ADD,
};
