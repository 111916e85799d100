"""The version and commit that every program tells, for those in Python: as program_version() in C++."""

import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent


def program_version():
    """Such as "0.2 ab12cd34ef56", with a "+" where the checkout has changes; the version alone outside one."""
    version = re.search(r"project\(nextview VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]
    try:
        commit = subprocess.run(["git", "-C", str(ROOT), "describe", "--always", "--dirty=+", "--abbrev=12",
                                 "--exclude=*"], capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return version
    return f"{version} {commit}"
