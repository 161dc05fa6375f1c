"""Colours and sizes of the explorer."""

from __future__ import annotations

ACCENT = "#0072b2"
"""The dithered motion, and everything that can be chosen."""

BEFORE = "#8a8a8a"
"""The motion without dither."""

MOMENT = "#f0e442"
"""The moment that is played."""

STICK = "#d55e00"
"""Sticking, instability and complaints."""

ENDS = ("#0072b2", "#d55e00", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#7f7f7f")
"""Motions on which starts end."""

FONT = "system-ui, 'DejaVu Sans', sans-serif"
TEXT = 15
"""Size of text in pixels."""

WIDTH = 436
"""Width of a picture in pixels."""

HEIGHT = 300
"""Height of a picture in pixels."""

SIDE = 316
"""Width of the column of numbers in pixels."""
