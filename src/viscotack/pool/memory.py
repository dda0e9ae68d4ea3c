"""Resident memory of a process, on systems that report it."""

import os
from pathlib import Path


def resident_memory(process: int | str = "self") -> float:
    """Return the resident memory of a process [bytes]; 0 if the system does not report it."""
    try:
        pages = int(Path(f"/proc/{process}/statm").read_text().split()[1])
        return pages * float(os.sysconf("SC_PAGE_SIZE"))
    except (OSError, ValueError, IndexError):
        return 0.0


def peak_memory() -> float:
    """Return the peak resident memory of this process [bytes]; 0 if unknown."""
    try:
        status = Path("/proc/self/status").read_text()
        peak = next(line for line in status.splitlines() if line.startswith("VmHWM:"))
        return 1024.0 * int(peak.split()[1])
    except (OSError, StopIteration):
        return 0.0
