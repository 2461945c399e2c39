"""Map of land on a grid of two degrees, and a texture of the Earth made from this map.

The map is computed with PyPI's `global-land-mask` 1.0.0 from the 30 arc second GLOBE elevation model (NOAA,
1999, public domain): a cell is land if more than half of its points are land.
"""

from __future__ import annotations

import base64
import zlib
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

_CELLS = (90, 180)
_SEA, _LAND, _ICE, _GRID = (
    np.array(rgb) for rgb in ((38, 86, 140), (86, 128, 82), (226, 232, 236), (90, 130, 170))
)
_PACKED = (
    "c-p;Hy>1jS5FX!#>=l8%E<uX2C(%$u;-{iOY$P6lnhxF|WhA1k6-7XS$Rp%2XjdUpN?Iz;5k)#=NQy<-^Wd4Wy&Jd=#1tFn^"
    "XJd==Q)6XWXb~SKhP4r8Ch@jTs%ayP!K;$Aly0gWPmCCw;bUm=%DswZ}*{cu*PWd_JhsPF=461dDD;plpkwT%6(fiM2DXN@C"
    "x1YL%`N=TbQF*L7#T7^k|Nsa3<&j`pj2#rwm+u4OFyDhPB-L`=pMjQykj{Jn|Cf5iKFtwcooWANDE%+YtwiZQ)&0`=>zw$Wg"
    "ET(+3TAr$M2)MMwQLN1ac@X%yBCC5s6FHzRtPviw>OiAk#c!b|x0f=L~Uu&V1fjCK&ogjTn$IDHVww4a%0uS7yeGA(vN^7d}"
    "bXpUT`Y#$`Pm!e!zQN5E!;1d&i03{-J2)hY{3tJA~4PEvcRA7!|#+ehl(JqOSbG0Of?Vb)vIk*1P#!lLSkipubxWrB$OvJ}4"
    "mv;$;$IVp8N2bb6g1ZpVyj7+iCD;b#FR-rcG@@A`qgKso|28JuLjD0OzNM2LS}CLfJptW670u~(FakXuyeoiF&LMBE4c=ADd"
    ";Y7Q_7_&9p*ZCAorKEsk=Jsnbx-byOo1*xEFvtWEjYzf*yzdZ9+6d}Y;uFhd8mgP%mS)x_uGizA{Thf+>?kF>>YNT%-ya2!i"
    "M(Vv);EpZW2Xncy0O%8**bsZqbQMe%7{$sS0F%DsJ4jrjQ%%K9O_D4LX)}Ay|_#$}}zhr#LGs<B=Psj>_2}4`Y?wsE0GOPrt"
    "dIvlsGb_c|KdBX5S_MCn2M_ZB)Y*9)h)U5Mt3NB{QX9|ZW%Hd+ja-r4Y-@IBQPHe)~W5RBnwKF=e1gcpO+xN=-^nUir>opIg"
    "k9<?%BeV=6mE{6GQV0*x&qoqhy1JnfxJRd4xS6tv<+b?r9phE"
)


def land() -> NDArray[np.bool_]:
    """Return cells (90, 180), True on land; rows go from north to south, columns from -180° to the east."""
    bits = np.frombuffer(zlib.decompress(base64.b85decode(_PACKED)), np.uint8)
    return np.unpackbits(bits).reshape(_CELLS).astype(bool)


def world_map(has_land: bool, times: int = 4, grid_deg: float = 30.0) -> NDArray[np.uint8]:
    """Return a (90 · times, 180 · times, 3) texture of the Earth with a grid, with or without land."""
    rows, columns = (times * cells for cells in _CELLS)
    fraction: NDArray[np.float64] = (
        _smooth(np.kron(land(), np.ones((times, times))).astype(np.float64), times)
        if has_land
        else np.zeros((rows, columns))
    )
    latitude = 90.0 - 180.0 * (np.arange(rows) + 0.5) / rows
    longitude = -180.0 + 360.0 * (np.arange(columns) + 0.5) / columns
    ice = ((np.abs(latitude[:, None]) > 72.0) | (latitude[:, None] < -60.0))[..., None]
    ground = np.where(ice, _ICE, _LAND)
    colors = np.where((fraction > 0.5)[..., None], ground, _SEA)
    step = 180.0 / rows
    lines = [np.abs((degrees + 1e-9) % grid_deg) < step for degrees in (latitude, longitude)]
    on_line = lines[0][:, None] | lines[1][None, :]
    colors[on_line] = (0.75 * colors[on_line] + 0.25 * np.array([200, 210, 220])).astype(int)
    return colors.astype(np.uint8)


def _smooth(values: NDArray[np.float64], reach: int) -> NDArray[np.float64]:
    """Return the running mean over ``reach`` cells on either side, periodic in longitude."""
    for axis, mode in ((0, "edge"), (1, "wrap")):
        width = [(0, 0), (0, 0)]
        width[axis] = (reach, reach)
        sums = np.cumsum(np.pad(values, width, mode=mode), axis=axis)  # type: ignore[call-overload]
        head = np.take(sums, [0], axis=axis) * 0.0
        sums = np.concatenate([head, sums], axis=axis)
        high = np.take(sums, np.arange(2 * reach + 1, sums.shape[axis]), axis=axis)
        low = np.take(sums, np.arange(sums.shape[axis] - 2 * reach - 1), axis=axis)
        values = (high - low) / (2 * reach + 1)
    return values
