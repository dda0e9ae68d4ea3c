"""Take the names of POSIX away from viscotack, as on Windows; put on PYTHONPATH by the tests.

Only viscotack sees this: the libraries that it uses have halves of their own for each system. The
locks of Windows are played by those of this system.
"""

import builtins
import fcntl
import os
import signal
import socket
import subprocess
import sys
import types

_IMPORT = builtins.__import__
_MISSING = {"fcntl", "resource", "pwd", "grp", "termios"}


def _locking(handle, mode, count):
    assert mode == 2 and count == 1
    try:
        # as on Windows, a process does not share its lock with itself
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:  # what Windows raises
        raise PermissionError(13, "Permission denied") from None


def _import(name, globals=None, locals=None, fromlist=(), level=0):
    asker = (globals or {}).get("__name__", "")
    if asker.startswith("viscotack") and name in _MISSING:
        raise ModuleNotFoundError(f"No module named {name!r}", name=name)
    if asker == "viscotack.system" and name == "msvcrt":
        return types.SimpleNamespace(locking=_locking, LK_NBLCK=2)
    found = _IMPORT(name, globals, locals, fromlist, level)
    if asker == "viscotack.system" and name == "psutil":
        found.BELOW_NORMAL_PRIORITY_CLASS = 19  # of Windows; here the highest niceness
    return found


class _Windows:
    """Import viscotack.system with the platform of Windows."""

    def find_spec(self, name, path, target=None):
        if name != "viscotack.system":
            return None
        from importlib.machinery import PathFinder

        spec = PathFinder.find_spec(name, path, target)
        execute = spec.loader.exec_module

        def exec_module(module):
            # decided while the module runs
            module.__dict__["sys"] = sys
            before, sys.platform = sys.platform, "win32"
            try:
                execute(module)
            finally:
                sys.platform = before

        spec.loader.exec_module = exec_module
        return spec


builtins.__import__ = _import
sys.meta_path.insert(0, _Windows())
for _module, _names in {
    os: ("pread", "pwrite", "O_NOFOLLOW", "O_NONBLOCK", "O_DIRECTORY", "nice"),
    signal: ("pthread_sigmask", "SIGUSR1"),
    socket: ("MSG_DONTWAIT",),
}.items():
    for _name in _names:
        delattr(_module, _name)
os.set_handle_inheritable = os.set_inheritable
subprocess.CREATE_NEW_PROCESS_GROUP = 0
