"""Multibody systems by the transfer matrix method (docs/mstmm.md): rigid bodies, hinges, loops."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Callable, NamedTuple, Optional

import numpy as np
import numpy.typing as npt

from ._interrupt import Interrupt
from ._library import (GO_ON, MSTMM_DRIVE, MSTMM_SINK, ld_error, ld_mstmm_assembly,
                       ld_mstmm_description, ld_mstmm_element, ld_mstmm_loop, ld_mstmm_mode,
                       ld_mstmm_settings, library)
from ._memory import Array, Handle, Held, coded
from .errors import UnknownName, check

#: Hinges, as the header of the library numbers them.
HINGES = ("weld", "revolute", "prismatic", "cylindrical", "universal", "spherical", "free",
          "planar")
Numbers = npt.ArrayLike


@dataclass(frozen=True)
class Body:
    """A rigid body and the hinge that carries it on its parent; hinge, order of coordinates, axes
    as docs/mstmm.md and launchdyn/mstmm.h have them.

    >>> bob = ld.Body("bob", hinge="revolute", axis=(0, 0, 1), mass=1, center=(-1, 0, 0))
    >>> bob.parent is None
    True
    """

    name: str
    parent: Optional[str] = None  #: the body that carries it; None: the ground
    hinge: str = "weld"  #: "revolute", "prismatic", ...
    at: Sequence[float] = (0, 0, 0)  #: [m] the hinge on the parent
    attitude: Sequence[float] = (1, 0, 0, 0)  #: quaternion, scalar first: hinge to parent
    axis: Sequence[float] = (0, 0, 0)  #: in the hinge frame
    axis_2: Sequence[float] = (0, 0, 0)
    stiffness: Sequence[float] = ()  #: of springs, one per speed [N m/rad] or [N/m]
    damping: Sequence[float] = ()  #: of dampers, one per speed
    rest: Sequence[float] = ()  #: coordinates without spring force
    mass: float = 0.0  #: [kg]
    center: Sequence[float] = (0, 0, 0)  #: [m] mass centre, body axes
    inertia: Sequence[float] = ()  #: [kg m2] xx yy zz xy xz yz about the mass centre


@dataclass(frozen=True)
class LoopJoint:
    """A joint that closes a loop between two bodies; None: the ground.

    >>> ld.LoopJoint("pin", "rod", None, "revolute", axis=(0, 0, 1)).joint
    'revolute'
    """

    name: str
    first: Optional[str]
    second: Optional[str]
    joint: str
    first_at: Sequence[float] = (0, 0, 0)  #: [m] the joint's point on the first body
    second_at: Sequence[float] = (0, 0, 0)
    axis: Sequence[float] = (0, 0, 0)
    axis_2: Sequence[float] = (0, 0, 0)
    stiffness: Sequence[float] = ()
    damping: Sequence[float] = ()
    rest: Sequence[float] = ()


class Energies(NamedTuple):
    """Energies of a multibody system [J].

    >>> pendulum.energy([0.0], [2.0]).kinetic
    2.0
    """

    kinetic: float
    potential: float  #: in gravity, zero at the inertial origin
    elastic: float  #: of springs


class Place(NamedTuple):
    """Place and motion of a point in inertial axes.

    >>> pendulum.locate("bob", [0.0], [2.0], at=(-1, 0, 0)).velocity
    array([ 0., -2.,  0.])
    """

    position: Array  #: [m]
    velocity: Array  #: [m/s]
    attitude: Array  #: quaternion, scalar first: body axes to inertial axes
    rate: Array  #: [rad/s]


class Vibration(NamedTuple):
    """A natural vibration about an equilibrium.

    >>> round(pendulum.vibration([np.pi / 2])[0].frequency, 6)  # sqrt(9.81)/(2 pi)
    0.498488
    """

    frequency: float  #: [Hz]; 0: it does not swing
    damping: float  #: [-] ratio
    rate: float  #: [1/s] real part of the eigenvalue
    shape: npt.NDArray[np.complex128]  #: of the speeds, the largest one 1


class Motion(NamedTuple):
    """A motion at its output instants.

    >>> pendulum.integrate([0.0], [0.0], end=1, output_step=0.1).q.shape
    (11, 1)
    """

    t: Array  #: [s]
    q: Array  #: coordinates, a row each
    u: Array  #: speeds, a row each


class Assembly(NamedTuple):
    """What closing the loops has found; forces of redundant constraints are not unique.

    >>> pendulum.assemble([0.1], [0.0])[2].freedoms
    1
    """

    freedoms: int
    held: int  #: independent constraints of the loops
    redundant: int  #: constraints that the others imply
    gap: float  #: [m] largest distance left in a joint
    turn: float  #: [rad] largest angle left
    singularity: float  #: 1 far from a singular pose, 0 in one


def _fill(to: Any, name: str, values: Numbers) -> None:
    found = np.asarray(values, np.float64)
    field = getattr(to, name)
    if found.ndim != 1 or len(found) > len(field):
        raise ValueError(f"{name}: expected up to {len(field)} numbers, found {found.tolist()}")
    field[:len(found)] = found.tolist()


def _kind(name: str) -> int:
    if name not in HINGES:
        raise UnknownName(f'there is no hinge "{name}"; there are {", ".join(HINGES)}')
    return HINGES.index(name)


def _element(body: Body) -> ld_mstmm_element:
    made = ld_mstmm_element(name=coded(body.name), hinge=_kind(body.hinge), mass=body.mass,
                            parent=None if body.parent is None else coded(body.parent))
    for name in ("at", "attitude", "axis", "axis_2", "stiffness", "damping", "rest", "center",
                 "inertia"):
        _fill(made, name, getattr(body, name))
    return made


def _loop(joint: LoopJoint) -> ld_mstmm_loop:
    made = ld_mstmm_loop(name=coded(joint.name), joint=_kind(joint.joint))
    for end in ("first", "second"):
        body = getattr(joint, end)
        getattr(made, end).element = None if body is None else coded(body)
        _fill(getattr(made, end), "at", getattr(joint, f"{end}_at"))
    for name in ("axis", "axis_2", "stiffness", "damping", "rest"):
        _fill(made, name, getattr(joint, name))
    return made


class Multibody(Held):
    """A system of rigid bodies, hinges and loops. Coordinates `q` and speeds `u` are arrays, body
    by body in the order given; wrenches are rows of force and moment about the body's origin, a
    row for each body, inertial axes. A context manager; it need not be closed. One thread at a
    time: others wait.

    >>> bob = ld.Body("bob", hinge="revolute", axis=(0, 0, 1), mass=1, center=(-1, 0, 0))
    >>> ld.Multibody([bob], gravity=(0, -9.81, 0)).accelerations([0.0], [0.0])
    array([9.81])
    """

    _over = "the system is closed"

    def __init__(self, bodies: Sequence[Body], loops: Sequence[LoopJoint] = (),
                 gravity: Sequence[float] = (0, -9.81, 0)) -> None:
        elements = (ld_mstmm_element * len(bodies))(*map(_element, bodies))
        joints = (ld_mstmm_loop * len(loops))(*map(_loop, loops))
        whole = ld_mstmm_description(elements=elements, element_count=len(bodies), loops=joints,
                                     loop_count=len(loops))
        _fill(whole, "gravity", gravity)
        error, pointer = ld_error(), ctypes.c_void_p()
        check(library.ld_mstmm_build(ctypes.byref(whole), ctypes.byref(pointer),
                                     ctypes.byref(error)), error)
        super().__init__(Handle(pointer.value, library.ld_mstmm_free))
        self.bodies = tuple(body.name for body in bodies)
        self._q = library.ld_mstmm_coordinate_count(pointer)
        self._u = library.ld_mstmm_speed_count(pointer)

    def __repr__(self) -> str:
        return f"<launchdyn.Multibody: bodies {len(self.bodies)}, speeds {self._u}>"

    def _array(self, name: str, values: Numbers, size: int) -> Array:
        found = np.array(values, np.float64).reshape(-1)
        if len(found) != size:
            raise ValueError(f"{name}: expected {size} numbers, found {len(found)}")
        return found

    def _state(self, q: Numbers, u: Numbers) -> tuple[Array, Array]:
        return self._array("q", q, self._q), self._array("u", u, self._u)

    def _loads(self, tau: Optional[Numbers],
               wrench: Optional[Numbers]) -> tuple[Optional[Array], Optional[Array]]:
        return (None if tau is None else self._array("tau", tau, self._u),
                None if wrench is None else self._array("wrench", wrench, 6 * len(self.bodies)))

    @property
    def reference(self) -> Array:
        """Coordinates of the reference state: zeros and unit quaternions.

        >>> pendulum.reference
        array([0.])
        """
        q = np.empty(self._q)
        with self._lock:
            library.ld_mstmm_reference(self._pointer, _data(q))
        return q

    def accelerations(self, q: Numbers, u: Numbers, tau: Optional[Numbers] = None,
                      wrench: Optional[Numbers] = None) -> Array:
        """Forward dynamics: rates of the speeds `u` at `q` under hinge forces `tau` and a `wrench`
        on each body; springs and dampers are added.

        >>> pendulum.accelerations([0.0], [0.0], tau=[1.0])
        array([10.81])
        """
        (q, u), (tau, wrench), error = self._state(q, u), self._loads(tau, wrench), ld_error()
        found = np.empty(self._u)
        with self._lock:
            check(library.ld_mstmm_accelerations(self._pointer, _data(q), _data(u), _data(tau),
                                                 _data(wrench), _data(found),
                                                 ctypes.byref(error)), error)
        return found

    def forces(self, q: Numbers, u: Numbers, u_dot: Numbers,
               wrench: Optional[Numbers] = None) -> Array:
        """Inverse dynamics: the hinge forces that make `u_dot` at `q` and `u`, on top of springs,
        dampers and a `wrench` on each body.

        >>> pendulum.forces([0.0], [0.0], [0.0])
        array([-9.81])
        """
        (q, u), (_, wrench) = self._state(q, u), self._loads(None, wrench)
        u_dot, found = self._array("u_dot", u_dot, self._u), np.empty(self._u)
        with self._lock:
            library.ld_mstmm_forces(self._pointer, _data(q), _data(u), _data(u_dot),
                                    _data(wrench), _data(found))
        return found

    def energy(self, q: Numbers, u: Numbers) -> Energies:
        """Energies [J] at coordinates `q` and speeds `u`.

        >>> sum(pendulum.energy([0.0], [2.0]))
        2.0
        """
        q, u = self._state(q, u)
        with self._lock:
            found = library.ld_mstmm_energy(self._pointer, _data(q), _data(u))
        return Energies(found.kinetic, found.potential, found.elastic)

    def momentum(self, q: Numbers, u: Numbers) -> tuple[Array, Array]:
        """Linear momentum [kg m/s] and angular momentum about the origin [kg m2/s] at `q`, `u`.

        >>> pendulum.momentum([0.0], [2.0])[1]
        array([0., 0., 2.])
        """
        (q, u), linear, angular = self._state(q, u), np.empty(3), np.empty(3)
        with self._lock:
            library.ld_mstmm_momentum(self._pointer, _data(q), _data(u), _data(linear),
                                      _data(angular))
        return linear, angular

    def locate(self, body: str, q: Numbers, u: Numbers, at: Numbers = (0, 0, 0)) -> Place:
        """Place and motion of the point `at` [m] of a `body` at `q` and `u`.

        >>> pendulum.locate("bob", [0.0], [0.0], at=(-1, 0, 0)).position
        array([-1.,  0.,  0.])
        """
        if body not in self.bodies:
            raise UnknownName(f'there is no body "{body}"; there are {", ".join(self.bodies)}')
        (q, u), at = self._state(q, u), self._array("at", at, 3)
        with self._lock:
            found = library.ld_mstmm_locate(self._pointer, _data(q), _data(u),
                                            self.bodies.index(body), _data(at))
        return Place(*(np.array(getattr(found, name)) for name in Place._fields))

    def assemble(self, q: Numbers, u: Numbers,
                 kept: Sequence[str] = ()) -> tuple[Array, Array, Assembly]:
        """Closes the loops: coordinates and speeds next to the guesses `q` and `u` that fit all
        joints, and what was found. Hinges of the bodies `kept` stay. Needed before a system with
        loops is evaluated.

        >>> pendulum.assemble([0.1], [0.2])[0]
        array([0.1])
        """
        q, u = self._state(q, u)
        for body in kept:
            if body not in self.bodies:
                raise UnknownName(f'there is no body "{body}"')
        held = (ctypes.c_int * len(self.bodies))(*(name in kept for name in self.bodies))
        error, found = ld_error(), ld_mstmm_assembly()
        with self._lock:
            check(library.ld_mstmm_assemble(self._pointer, _data(q), _data(u), held,
                                            ctypes.byref(found), ctypes.byref(error)), error)
        return q, u, Assembly(*(getattr(found, name) for name in Assembly._fields))

    def vibration(self, q: Numbers, tau: Optional[Numbers] = None) -> list[Vibration]:
        """Natural vibrations about the equilibrium `q`, held by constant `tau`, ascending.

        >>> len(pendulum.vibration([np.pi / 2]))
        1
        """
        q, (tau, _), error = self._array("q", q, self._q), self._loads(tau, None), ld_error()
        modes, count = (ld_mstmm_mode * max(self._u, 1))(), ctypes.c_int()
        shapes = np.zeros((max(self._u, 1), self._u), np.complex128)
        with self._lock:
            check(library.ld_mstmm_vibration(self._pointer, _data(q), _data(tau), modes,
                                             _data(shapes), ctypes.byref(count),
                                             ctypes.byref(error)), error)
        return [Vibration(mode.frequency, mode.damping, mode.rate, shapes[i].copy())
                for i, mode in enumerate(modes[:count.value])]

    def integrate(self, q: Numbers, u: Numbers, end: float, *, start: float = 0.0,
                  output_step: float = 0.0, tolerance: float = 1e-8,
                  drive: Optional[Callable[[float, Array, Array], Optional[Numbers]]] = None
                  ) -> Motion:
        """The motion from `q` and `u` at `start` to `end` [s], at every `output_step` (0: start
        and end), by error-controlled steps of relative and absolute `tolerance`. `drive(t, q, u)`
        gives the hinge forces, None: none; it must not use this system. Ctrl-C stops it at the next
        output.

        >>> pendulum.integrate([0.0], [0.0], end=1, output_step=0.5).t
        array([0. , 0.5, 1. ])
        """
        (q, u), error = self._state(q, u), ld_error()
        rows: list[tuple[float, Array, Array]] = []
        with self._lock, Interrupt() as interrupt:
            raised: list[BaseException] = []
            go_on = GO_ON(interrupt.asking())

            def ask(t: float, at_q: Any, at_u: Any, tau: Any, _wrench: Any, _: Any) -> None:
                to = _view(tau, self._u, True)
                try:
                    assert drive and not raised
                    given = drive(t, _view(at_q, self._q), _view(at_u, self._u))
                    if given is not None:
                        to[:] = self._array("tau", given, self._u)
                except BaseException as found:  # raised again once the library has returned
                    raised.append(found)
                    to[:] = np.nan

            def take(t: float, at_q: Any, at_u: Any, _: Any) -> int:
                rows.append((t, _view(at_q, self._q).copy(), _view(at_u, self._u).copy()))
                return int(bool(raised) or not go_on(None))

            settings = ld_mstmm_settings(
                rtol=tolerance, atol=tolerance, output_step=output_step or end - start,
                sink=MSTMM_SINK(take))
            if drive:
                settings.drive = MSTMM_DRIVE(ask)
            status = library.ld_mstmm_integrate(self._pointer, ctypes.byref(settings), start, end,
                                                _data(q), _data(u), None, ctypes.byref(error))
            if raised:
                raise raised[0]
        check(status, error)
        return Motion(*(np.array([row[i] for row in rows]) for i in range(3)))


def _data(array: Optional[npt.NDArray[Any]]) -> Any:
    return None if array is None else array.ctypes.data


def _view(address: Any, count: int, writable: bool = False) -> Array:
    if not count:
        return np.empty(0)
    found: Array = np.ctypeslib.as_array(address, (count,))
    found.flags.writeable = writable
    return found
