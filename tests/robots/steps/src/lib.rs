//! Steps with slopes of real robots against Pinocchio's: `tests/robots/steps.sh`.
