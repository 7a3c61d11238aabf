"""The command line: `hamel`, or `python -m hamel`."""

import signal
import sys

from ._hamel import command


def main() -> int:
    """Run the command given by `sys.argv`, and return its exit status."""
    # Ctrl-C ends the process like any other command, without a KeyboardInterrupt.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return command(sys.argv)


if __name__ == "__main__":
    sys.exit(main())
