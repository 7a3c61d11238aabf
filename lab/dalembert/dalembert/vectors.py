"""Vectors and matrices of size three, as lists of high-precision numbers: faster than matrices of mpmath, with only the
needed functions."""

from mpmath import cos, matrix, mp, mpf, sin, sqrt
from mpmath import lu_solve

mp.dps = 80
ONE, NIL = mpf(1), mpf(0)
IDENTITY = [[ONE, NIL, NIL], [NIL, ONE, NIL], [NIL, NIL, ONE]]


def add(a, b):
    return [x + y for x, y in zip(a, b)]


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def scale(k, a):
    return [k * x for x in a]


def dot(a, b):
    return sum((x * y for x, y in zip(a, b)), NIL)


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def norm(a):
    return sqrt(dot(a, a))


def hat(w):
    return [[NIL, -w[2], w[1]], [w[2], NIL, -w[0]], [-w[1], w[0], NIL]]


def vee(m):
    """The vector of the antisymmetric part."""
    return [(m[2][1] - m[1][2]) / 2, (m[0][2] - m[2][0]) / 2, (m[1][0] - m[0][1]) / 2]


def transposed(m):
    return [list(row) for row in zip(*m)]


def times(a, b):
    return [[sum((a[i][k] * b[k][j] for k in range(len(b))), NIL) for j in range(len(b[0]))] for i in range(len(a))]


def on(m, v):
    return [dot(row, v) for row in m]


def plus(a, b):
    return [add(x, y) for x, y in zip(a, b)]


def multiple(k, m):
    return [scale(k, row) for row in m]


def unit(n):
    length = norm(n)
    return [x / length for x in n]


def turn(n, c, s):
    """The rotation about the unit vector n by the angle of cosine c and sine s."""
    h = hat(n)
    return plus(plus(IDENTITY, multiple(s, h)), multiple(1 - c, times(h, h)))


def about(n, angle):
    return turn(unit(n), cos(angle), sin(angle))


def quaternion(q):
    """The rotation of a unit quaternion, scalar first."""
    w, x, y, z = q
    return [
        [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
    ]


def solve(a, b):
    """The solution of a square system; b a list."""
    return list(lu_solve(matrix(a), matrix(b))) if b else []


def least_squares(a, b):
    """The solution of an overdetermined system of full rank, by its normal equations: half of the digits are enough."""
    columns = transposed(a)
    return solve([[dot(p, q) for q in columns] for p in columns], [dot(p, b) for p in columns])
