"""The command line: `hamel`, or `python -m hamel`."""

import signal
import sys

from ._hamel import command


def main() -> int:
    """Runs the command that the arguments of this process are; its exit status."""
    # A command that is interrupted, or whose reader has gone, ends as one that is no Python.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return command(sys.argv)


if __name__ == "__main__":
    sys.exit(main())
