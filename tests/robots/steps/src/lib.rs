//! Compares steps with slopes of real robots with Pinocchio's; run by `tests/robots/steps.sh`.
