//! Steps with slopes of real robots against Pinocchio's: `lab/robots/run.sh`.
