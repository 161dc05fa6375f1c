"""``python3 benches/twenty_modes.py [FROM TO] | quell design -``: a structure of 20 modes on one contact, whose least dither is asked for.

With FROM and TO the frequency of the dither is chosen between them, otherwise it is 40.
"""

from __future__ import annotations

import sys

MODE = """[[system.mode]]
frequency = {frequency}
damping_ratio = 0.005
shape = {{ tip = {share}, drive = {drive} }}
"""

STUDY = """[system]
units = "none"
{modes}
[[contact]]
name = "belt"
tangent = {{ tip = 1.0 }}
normal_load = 1.0
belt_velocity = 0.1

[friction]
law = "stribeck"
static_coefficient = 0.4
minimum_coefficient = 0.2857
reference_velocity = 0.2

[[dither]]
at = {{ drive = 1.0 }}
waveform = "sine"
amplitude = 1.0
frequency = 40.0

[design]
minimise = "amplitude"
vary = [{vary}]
from = [{low}]
to = [{high}]

[design.over]
"contact.belt.belt_velocity" = [0.05, 0.15]
"""

modes = "".join(MODE.format(frequency=1.0 + 0.2 * k, share=1.0 / (1 + k), drive=0.8 / (1 + k)) for k in range(20))
vary, low, high = ['"dither.amplitude"'], ["0.01"], ["100.0"]
if len(sys.argv) == 3:
    vary.append('"dither.frequency"')
    low.append(str(float(sys.argv[1])))
    high.append(str(float(sys.argv[2])))
print(STUDY.format(modes=modes, vary=", ".join(vary), low=", ".join(low), high=", ".join(high)))
