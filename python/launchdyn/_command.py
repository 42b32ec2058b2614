"""The command launchdyn of an installed package."""

import os
import shutil
import sys
from pathlib import Path


def main() -> None:
    """Runs the command that lies in the package. Without one, the next of this name in PATH."""
    command = str(Path(__file__).with_name("launchdyn"))
    if not os.access(command, os.X_OK):
        own = Path(sys.argv[0]).resolve().parent
        others = (folder for folder in os.get_exec_path() if Path(folder).resolve() != own)
        found = shutil.which("launchdyn", path=os.pathsep.join(others))
        if not found:
            sys.exit("launchdyn: this package has no command, and PATH has no other; build "
                     "launchdyn and install it, or install a wheel that scripts/wheel made")
        command = found
    os.execv(command, [command, *sys.argv[1:]])
