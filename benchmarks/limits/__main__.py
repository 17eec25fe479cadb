# SPDX-License-Identifier: GPL-3.0-or-later
"""`python -m benchmarks.limits`; what processes of their own must find by name is in run.py."""

from __future__ import annotations

import sys

from benchmarks.limits.run import main

if __name__ == "__main__":
    sys.exit(main())
