"""IEC 61260-1:2014, table 1, class 1, for one-third-octave bands."""

import numpy as np

# Normalised frequency G^x for an octave filter with the least and greatest relative attenuation
# [dB]; mapped to one-third octaves by the standard's equation 9.
_OCTAVE = [0.0, 1 / 8, 1 / 4, 3 / 8, 0.4999999, 0.5000001, 1.0, 2.0, 3.0, 4.0]
_LEAST = [-0.4, -0.4, -0.4, -0.4, -0.4, 1.6, 16.6, 40.5, 60.0, 70.0]
_GREATEST = [0.4, 0.5, 0.7, 1.4, 5.3, np.inf, np.inf, np.inf, np.inf, np.inf]


def mask(ratio):
    """Return least and greatest attenuation at frequency over mid-band frequency."""
    g = 10**0.3
    third = []
    for x in _OCTAVE:
        octave = g**x
        third.append(1 + (g ** (1 / 6) - 1) / (g**0.5 - 1) * (octave - 1))
    third = np.log(third)
    position = np.abs(np.log(ratio))
    least = np.interp(position, third, _LEAST)
    greatest = np.interp(position, third[:5], _GREATEST[:5], right=np.inf)
    return least, greatest
