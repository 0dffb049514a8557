"""Copies into a wheel all shared libraries that it needs, but for the C and C++ runtime.

    python repair_wheel.py WHEEL FOLDER

auditwheel (PyPA) does it; by its own rules it would leave out X11, GL and GLib, which OpenCV of Debian
links and which a container has not. The repaired wheel in FOLDER runs where glibc is at least that of
the system it is made on: Debian 12 has 2.36.
"""

import json
import pathlib
import sys
import tempfile

from auditwheel import main, policy
from auditwheel.libc import Libc

_PLATFORM = "manylinux_2_36_x86_64"
_RUNTIME = {"ld-linux-x86-64.so.2", "libc.so.6", "libdl.so.2", "libgcc_s.so.1", "libm.so.6",
            "libmvec.so.1", "libnsl.so.1", "libpthread.so.0", "libresolv.so.2", "librt.so.1",
            "libstdc++.so.6", "libutil.so.1"}


def repair(wheel, folder):
    """Returns auditwheel's exit code."""
    policies = json.loads(policy._POLICY_JSON_MAP[Libc.GLIBC].read_text())
    for entry in policies:
        entry["lib_whitelist"] = [name for name in entry["lib_whitelist"] if name in _RUNTIME]
    with tempfile.TemporaryDirectory() as temporary:
        own = pathlib.Path(temporary) / "policies.json"
        own.write_text(json.dumps(policies))
        policy._POLICY_JSON_MAP[Libc.GLIBC] = own
        sys.argv = ["auditwheel", "repair", wheel, "--plat", _PLATFORM, "-w", folder]
        # The wheel has its own (isolate_symbols.py), which auditwheel would add a second time.
        for name in ("libc10.so*", "libtorch.so*", "libtorch_cpu.so*"):
            sys.argv += ["--exclude", name]
        return main.main()


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(repair(*sys.argv[1:]))
