"""Ways to break the library: each replaces a text that occurs once in a header, and some test must notice.

`tests` are the programs that should, the likeliest first. `scalar` mutants are built with the plain loops. A mutant that
no test can notice says why in `survives`.
"""

from .arithmetic import ARITHMETIC
from .culling import CULLING
from .diagnosis import DIAGNOSIS
from .headers import HEADERS
from .kernels import KERNELS
from .matrices import MATRICES
from .points import POINTS
from .simd import SIMD
from .triangle import TRIANGLE

MUTANTS = [*HEADERS, *MATRICES, *ARITHMETIC, *POINTS, *CULLING, *TRIANGLE, *KERNELS, *SIMD, *DIAGNOSIS]
