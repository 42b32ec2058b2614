"""Multibody systems by the transfer matrix method (docs/mstmm.md): rigid bodies, beams, hinges,
loops."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Callable, NamedTuple, Optional, Union

import numpy as np
import numpy.typing as npt

from ._interrupt import Interrupt
from ._library import (GO_ON, MSTMM_DRIVE, MSTMM_MOTION, MSTMM_SINK, ld_error,
                       ld_mstmm_assembly, ld_mstmm_beam, ld_mstmm_description, ld_mstmm_element,
                       ld_mstmm_loop, ld_mstmm_mode, ld_mstmm_settings, ld_section, library)
from ._memory import Array, Handle, Held, coded
from .errors import UnknownName, check

#: Hinges, as the header of the library numbers them: how many coordinates and speeds.
HINGES = {"weld": (0, 0), "revolute": (1, 1), "prismatic": (1, 1), "cylindrical": (2, 2),
          "universal": (2, 2), "spherical": (4, 3), "free": (7, 6), "planar": (3, 3)}
#: Spans and forms of sections likewise.
SPANS = {"clamped": 1, "free-free": 2, "tip-loaded": 3}
PLANES = 3
Numbers = npt.ArrayLike


@dataclass(frozen=True)
class Section:
    """A stretch of a beam with constant section, from `start` to the next one's or to the end.

    >>> ld.Section(0.645, 3025, 1.67e7, 2270, 2.33e-4).bending_stiffness
    3025
    """

    mass_per_length: float  #: [kg/m]
    bending_stiffness: Union[float, Sequence[float]]  #: [N m2] E I, or those about y and about z
    axial_stiffness: float  #: [N] E A
    torsion_stiffness: float  #: [N m2] G I_t
    polar_inertia: float  #: [kg m] of the mass about the axis, per length
    start: float = 0.0  #: [m] station where it begins

    @classmethod
    def tube(cls, outer_radius: float, inner_radius: float = 0.0, *, density: float,
             youngs_modulus: float, shear_modulus: float, start: float = 0.0) -> Section:
        """A round tube, or a rod, from `outer_radius` and `inner_radius` [m], `density` [kg/m3],
        `youngs_modulus` and `shear_modulus` [Pa], from the station `start` [m] on.

        >>> pipe = ld.Section.tube(0.02, 0.018, density=2700, youngs_modulus=70e9,
        ...                        shear_modulus=26e9)
        >>> round(pipe.mass_per_length, 3), round(pipe.bending_stiffness)
        (0.645, 3025)
        """
        area = math.pi * (outer_radius**2 - inner_radius**2)
        moment = math.pi / 4 * (outer_radius**4 - inner_radius**4)
        return cls(density * area, youngs_modulus * moment, youngs_modulus * area,
                   2 * shear_modulus * moment, 2 * density * moment, start)


@dataclass(frozen=True)
class Beam:
    """A flexible beam along its body's x axis: small bending, torsion and stretch by modes in a
    frame fixed to its rear end, as docs/theory-tube.md has them. `modes` of bending count for each
    plane.

    >>> pipe = ld.Section(0.645, 3025, 1.67e7, 2270, 2.33e-4)
    >>> arm = ld.Multibody([ld.Body("arm", beam=ld.Beam(2, pipe))], gravity=(0, 0, 0))
    >>> round(arm.vibration(arm.reference)[0].frequency, 2)  # 1.8751^2 sqrt(3025/0.645/2^4)/(2 pi)
    9.58
    """

    length: float  #: [m]
    sections: Union[Section, Sequence[Section]]  #: from the rear end on
    bending: int = 4  #: modes a plane, at least 1
    torsion: int = 1  #: modes
    axial: int = 0  #: modes
    damping: float = 0.0  #: [-] ratio, of the modes clamped at the rear end
    span: str = "tip-loaded"  #: "clamped", "free-free": how the shapes are held
    geometric_stiffness: bool = True  #: axial forces stiffen or soften bending
    shear_coefficient: float = 0.0  #: [-] k of k G A, with rotary inertia; 0: neither
    elements: int = 40  #: finite elements at least


@dataclass(frozen=True)
class Body:
    """A rigid body, or a beam, and the hinge that carries it on its parent; hinge, order of
    coordinates, axes as docs/mstmm.md and launchdyn/mstmm.h have them. Coordinates of a beam's
    modes follow those of its hinge. Without mass it is a frame: welded, or on a prescribed hinge.

    >>> bob = ld.Body("bob", hinge="revolute", axis=(0, 0, 1), mass=1, center=(-1, 0, 0))
    >>> bob.parent is None
    True
    """

    name: str
    parent: Optional[str] = None  #: the body that carries it; None: the ground
    hinge: str = "weld"  #: "revolute", "prismatic", ...
    #: [m] the hinge on the parent; on a beam: station, then y and z in the deformed section's axes
    at: Sequence[float] = (0, 0, 0)
    attitude: Sequence[float] = (1, 0, 0, 0)  #: quaternion, scalar first: hinge to parent
    axis: Sequence[float] = (0, 0, 0)  #: in the hinge frame
    axis_2: Sequence[float] = (0, 0, 0)
    stiffness: Sequence[float] = ()  #: of springs, one per speed [N m/rad] or [N/m]
    damping: Sequence[float] = ()  #: of dampers, one per speed
    rest: Sequence[float] = ()  #: coordinates without spring force
    mass: float = 0.0  #: [kg]
    center: Sequence[float] = (0, 0, 0)  #: [m] mass centre, body axes
    inertia: Sequence[float] = ()  #: [kg m2] xx yy zz xy xz yz about the mass centre
    beam: Optional[Beam] = None  #: the body is this beam; mass, center, inertia are not used
    prescribed: bool = False  #: the hinge's motion is given: `tau` is what its speeds' rates are


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
    elastic: float  #: of beams and springs


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


class Reactions(NamedTuple):
    """What hinges and loops transmit: rows of force [N] and moment [N m] in inertial axes.

    >>> pendulum.reactions([0.0], [2.0]).hinges[0, :3]  # m omega^2 l towards the hinge
    array([4., 0., 0.])
    """

    hinges: Array  #: a row for each body: on it, about its origin, springs and `tau` included
    loops: Array  #: a row for each loop's joint: on its second side, about the joint's point
    rates: Array  #: of the speeds


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
    return list(HINGES).index(name)


def _section(given: Section) -> ld_section:
    made = ld_section(form=PLANES, mass_per_length=given.mass_per_length,
                      axial_stiffness=given.axial_stiffness,
                      torsion_stiffness=given.torsion_stiffness,
                      polar_inertia=given.polar_inertia)
    setattr(made, "from", given.start)
    about = np.asarray(given.bending_stiffness, np.float64).reshape(-1)
    if len(about) not in (1, 2):
        raise ValueError("bending_stiffness: expected a number, or one about y and one about z")
    made.bending_stiffness_y, made.bending_stiffness_z = about[0], about[-1]
    made.bending_stiffness = about.mean()
    return made


def _beam(given: Beam) -> Any:
    if given.span not in SPANS:
        raise UnknownName(f'there is no span "{given.span}"; there are {", ".join(SPANS)}')
    sections = [given.sections] if isinstance(given.sections, Section) else given.sections
    made = (ld_section * len(sections))(*map(_section, sections))
    return ctypes.pointer(ld_mstmm_beam(
        length=given.length, section_count=len(sections), section=made, bending=given.bending,
        torsion=given.torsion, axial=given.axial, elements=given.elements, damping=given.damping,
        span=SPANS[given.span], geometric_stiffness=bool(given.geometric_stiffness),
        shear_coefficient=given.shear_coefficient))


def _element(body: Body) -> ld_mstmm_element:
    made = ld_mstmm_element(name=coded(body.name), hinge=_kind(body.hinge), mass=body.mass,
                            parent=None if body.parent is None else coded(body.parent),
                            beam=None if body.beam is None else _beam(body.beam),
                            prescribed=bool(body.prescribed))
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
    """A system of rigid bodies, beams, hinges and loops. Coordinates `q` and speeds `u` are arrays,
    body by body in the order given; wrenches are rows of force and moment about the body's origin,
    a row for each body, inertial axes. A context manager; it need not be closed. One thread at a
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
        self._hinges = [HINGES[body.hinge] for body in bodies]
        self._given = [bool(body.prescribed) for body in bodies]
        self._loops = len(loops)
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

    def _index(self, body: str) -> int:
        if body not in self.bodies:
            raise UnknownName(f'there is no body "{body}"; there are {", ".join(self.bodies)}')
        return self.bodies.index(body)

    def coordinates(self, body: str) -> slice:
        """Where the coordinates of a `body` lie in `q`: of its hinge, then of a beam's modes.

        >>> pendulum.coordinates("bob")
        slice(0, 1, None)
        """
        return self._part(body, library.ld_mstmm_coordinate_offset, self._q)

    def speeds(self, body: str) -> slice:
        """Where the speeds of a `body` lie in `u`, likewise.

        >>> pendulum.speeds("bob")
        slice(0, 1, None)
        """
        return self._part(body, library.ld_mstmm_speed_offset, self._u)

    def _part(self, body: str, offset: Callable[[int, int], int], end: int) -> slice:
        i = self._index(body)
        with self._lock:
            return slice(offset(self._pointer, i), end if i + 1 == len(self.bodies) else
                         offset(self._pointer, i + 1))

    def prescribe(self, body: str, prescribed: bool = True) -> None:
        """From now on the motion of the hinge of a `body` is `prescribed`, or free again. At rest
        it is a lock.

        >>> lock = ld.Multibody([ld.Body("bob", hinge="revolute", axis=(0, 0, 1), mass=1,
        ...                              center=(-1, 0, 0))])
        >>> lock.prescribe("bob")
        >>> lock.accelerations([0.0], [0.0])
        array([0.])
        """
        i = self._index(body)
        with self._lock:
            library.ld_mstmm_prescribe(self._pointer, i, bool(prescribed))
            self._given[i] = bool(prescribed)

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
        on each body; springs and dampers are added. Of prescribed hinges `tau` has the rates.

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
        """Inverse dynamics: the hinge forces, also of prescribed hinges, that make `u_dot` at `q`
        and `u`, on top of springs, dampers and a `wrench` on each body; joints of loops carry their
        springs only.

        >>> pendulum.forces([0.0], [0.0], [0.0])
        array([-9.81])
        """
        (q, u), (_, wrench) = self._state(q, u), self._loads(None, wrench)
        u_dot, found = self._array("u_dot", u_dot, self._u), np.empty(self._u)
        with self._lock:
            library.ld_mstmm_forces(self._pointer, _data(q), _data(u), _data(u_dot),
                                    _data(wrench), _data(found))
        return found

    def reactions(self, q: Numbers, u: Numbers, tau: Optional[Numbers] = None,
                  wrench: Optional[Numbers] = None) -> Reactions:
        """What hinges and loops transmit while the system moves from `q` and `u` under `tau` and
        `wrench`, as of accelerations().

        >>> pendulum.reactions([np.pi / 2], [0.0]).hinges[0, :3].round(12)  # hanging at rest
        array([0.  , 9.81, 0.  ])
        """
        (q, u), (tau, wrench), error = self._state(q, u), self._loads(tau, wrench), ld_error()
        rates, hinges = np.empty(self._u), np.empty((len(self.bodies), 6))
        loops = np.empty((self._loops, 6))
        with self._lock:
            check(library.ld_mstmm_accelerations(self._pointer, _data(q), _data(u), _data(tau),
                                                 _data(wrench), _data(rates),
                                                 ctypes.byref(error)), error)
            library.ld_mstmm_reactions(self._pointer, _data(q), _data(u), _data(rates),
                                       _data(wrench), _data(hinges))
            for i, row in enumerate(loops):
                library.ld_mstmm_loop_force(self._pointer, i, _data(row))
        return Reactions(hinges, loops, rates)

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
        """Place and motion of the point `at` [m] of a `body` at `q` and `u`; on a beam: station,
        then y and z in the axes of the deformed section there.

        >>> pendulum.locate("bob", [0.0], [0.0], at=(-1, 0, 0)).position
        array([-1.,  0.,  0.])
        """
        i, (q, u), at = self._index(body), self._state(q, u), self._array("at", at, 3)
        with self._lock:
            found = library.ld_mstmm_locate(self._pointer, _data(q), _data(u), i, _data(at))
        return Place(*(np.array(getattr(found, name)) for name in Place._fields))

    def assemble(self, q: Numbers, u: Numbers,
                 kept: Sequence[str] = ()) -> tuple[Array, Array, Assembly]:
        """Closes the loops: coordinates and speeds next to the guesses `q` and `u` that fit all
        joints, and what was found. Hinges of the bodies `kept` and prescribed ones stay. Needed
        before a system with loops is evaluated.

        >>> pendulum.assemble([0.1], [0.2])[0]
        array([0.1])
        """
        q, u = self._state(q, u)
        for body in kept:
            self._index(body)
        held = (ctypes.c_int * len(self.bodies))(*(name in kept for name in self.bodies))
        error, found = ld_error(), ld_mstmm_assembly()
        with self._lock:
            check(library.ld_mstmm_assemble(self._pointer, _data(q), _data(u), held,
                                            ctypes.byref(found), ctypes.byref(error)), error)
        return q, u, Assembly(*(getattr(found, name) for name in Assembly._fields))

    def vibration(self, q: Numbers, tau: Optional[Numbers] = None) -> list[Vibration]:
        """Natural vibrations about the equilibrium `q`, held by constant `tau`, ascending;
        prescribed hinges hold.

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
                  drive: Optional[Callable[[float, Array, Array], Optional[Numbers]]] = None,
                  motion: Optional[Callable[[float], Mapping[str, Sequence[Numbers]]]] = None
                  ) -> Motion:
        """The motion from `q` and `u` at `start` to `end` [s], at every `output_step` (0: start
        and end), by error-controlled steps of relative and absolute `tolerance`. `drive(t, q, u)`
        gives the hinge forces, None: none. `motion(t)` gives coordinates, speeds and the rates of
        these of prescribed hinges, by bodies; without it they move as they start. Neither may use
        this system. Ctrl-C stops it at the next output.

        >>> pendulum.integrate([0.0], [0.0], end=1, output_step=0.5).t
        array([0. , 0.5, 1. ])
        >>> cart = ld.Body("cart", hinge="prismatic", axis=(1, 0, 0), mass=1, prescribed=True)
        >>> ld.Multibody([cart]).integrate([0], [0], end=2, motion=lambda t: {
        ...     "cart": ([t**2], [2 * t], [2])}).q[-1]
        array([4.])
        """
        (q, u), error = self._state(q, u), ld_error()
        places = {body: (self.coordinates(body).start, self.speeds(body).start, *size)
                  for body, size in zip(self.bodies, self._hinges)}
        moved = np.zeros(self._u, bool)  # speeds whose rates `motion` gives
        for body, given in zip(self.bodies, self._given):
            _, at_u, _, count = places[body]
            moved[at_u:at_u + count] = given and motion is not None
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
                        to[~moved] = self._array("tau", given, self._u)[~moved]
                except BaseException as found:  # raised again once the library has returned
                    raised.append(found)
                    to[:] = np.nan

            def move(t: float, at_q: Any, at_u: Any, rates: Any, _: Any) -> None:
                to_q, to_u, to_rates = (_view(address, count, True) for address, count in
                                        ((at_q, self._q), (at_u, self._u), (rates, self._u)))
                try:
                    assert motion and not raised
                    for body, given in motion(t).items():
                        if not self._given[self._index(body)]:
                            raise ValueError(f"{body}: its hinge is not prescribed")
                        of_q, of_u, coordinates, speeds = places[body]
                        of_hinge, at_rate, rate = given
                        to_q[of_q:of_q + coordinates] = \
                            self._array(f"{body}: coordinates", of_hinge, coordinates)
                        to_u[of_u:of_u + speeds] = self._array(f"{body}: speeds", at_rate, speeds)
                        to_rates[of_u:of_u + speeds] = self._array(f"{body}: rates", rate, speeds)
                except BaseException as found:  # likewise
                    raised.append(found)
                    to_rates[:] = np.nan

            def take(t: float, at_q: Any, at_u: Any, _: Any) -> int:
                rows.append((t, _view(at_q, self._q).copy(), _view(at_u, self._u).copy()))
                return int(bool(raised) or not go_on(None))

            settings = ld_mstmm_settings(
                rtol=tolerance, atol=tolerance, output_step=output_step or end - start,
                sink=MSTMM_SINK(take))
            if drive:
                settings.drive = MSTMM_DRIVE(ask)
            if motion:
                settings.motion = MSTMM_MOTION(move)
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
