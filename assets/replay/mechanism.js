// Bodies, beams, joints and force elements of a base: what they look like, from the geometry, and where they are at an
// instant, from the columns. A thing is known by its number: bodies, then beams, -1 the ground, -2 the carrier.
import { nodesOf, sectionOf, shapesOf } from "./curve.js";
import { add, apply, multiply, pose, subtract, turnedBack } from "./vector.js";

export const CARRIER = -2;
const IDENTITY = [1, 0, 0, 0, 1, 0, 0, 0, 1];
const KINDS = ["fixed", "revolute", "prismatic", "cylindrical", "universal", "spherical", "planar", "free"];
const SHAPES = [null, "box", "cylinder", "ellipsoid", "mesh"];

// `rows`: an array of the geometry by its name, as a list of rows; `columns`: names of the launch's columns. Null where the
// base is of another kind.
export function mechanismOf(rows, columns) {
  const single = (name) => rows(name)[0]?.[0], named = (head, tail) => [...columns].filter((name) => name.startsWith(head) && name.endsWith(tail))
    .map((name) => name.slice(head.length, name.length - tail.length));
  if (rows("joint.kind").length === 0) return null;
  const bodies = named("body.", ".yaw").map((name, i) => ({ name, shape: SHAPES[rows("body.shape")[i][0]], at: rows("body.at")[i],
    A: pose(...rows("body.attitude")[i]), size: rows("body.size")[i], triangles: trianglesOf(rows, i) }));
  const beams = named("beam.", ".yaw").map((name, i) => beamOf(rows, name, i + 1));
  const joints = rows("joint.kind").map(([kind], i) => ({ kind: KINDS[kind], parent: rows("joint.link")[i][0], body: rows("joint.link")[i][1],
    at: rows("joint.at")[i], A: pose(...rows("joint.attitude")[i]), axis: rows("joint.axis")[i] }));
  joints.forEach((joint, i) => { joint.closes = joints.findIndex(({ body }) => body === joint.body) < i; });
  return {
    bodies, beams, joints, on: single("tubes.on"), carried: columns.includes("carrier.yaw"),
    struts: rows("strut.at").map((at, i) => ({ ends: rows("strut.link")[i], at: [at.slice(0, 3), at.slice(3)], driven: rows("strut.driven")[i][0] === 1 })),
    bushings: rows("bushing.at").map((at, i) => ({ on: rows("bushing.on")[i][0], at })),
    feet: rows("foot.at").map((at, i) => ({ on: rows("foot.on")[i][0], at, height: rows("foot.height")[i][0] })),
    wheels: single("wheel.on") === undefined ? [] : named("wheel.", ".travel"), wheelsOn: single("wheel.on"), wheelRadius: single("wheel.radius"),
  };
}

// Of a body's mesh, in the axes of its shape: corners, nine numbers each, and colours.
function trianglesOf(rows, body) {
  const own = rows("body.mesh").filter(([number]) => number === body);
  return { corners: own.map((row) => row.slice(1, 10)), colours: own.map((row) => row.slice(10)) };
}

function beamOf(rows, name, number) {
  const shapes = shapesOf(rows, `beam.${number}`), sections = rows(`beam.${number}.section`), length = shapes.stations.at(-1);
  const radius = (x) => sections.filter(([from]) => from <= x).at(-1)?.[2] ?? 0.015 * length;
  return { name, shapes, length, radii: shapes.stations.map(radius) };
}

// Where everything is. `poseOf`: a frame { r, A } by the beginning of its columns; `read`: a column.
export function placesOf({ bodies, beams, wheels, carried }, poseOf, read) {
  return {
    bodies: bodies.map(({ name }) => poseOf(`body.${name}.`)),
    beams: beams.map(({ name, shapes }) => ({ ...poseOf(`beam.${name}.`),
      nodes: nodesOf(shapes, Array.from({ length: shapes.count }, (_, i) => read(`beam.${name}.q${i + 1}`))) })),
    wheels: wheels.map((name) => ["x", "y", "z"].map((axis) => read(`wheel.${name}.${axis}`))),
    carrier: carried ? poseOf("carrier.") : null,
  };
}

// The frame of a thing's point in I; of a beam a station, then y and z in the axes of the section.
export function frameOf({ bodies }, places, thing, at) {
  if (thing === CARRIER && places.carrier) return moved(places.carrier, at);
  if (thing < 0) return { r: at, A: IDENTITY };
  if (thing < bodies.length) return moved(places.bodies[thing], at);
  const beam = places.beams[thing - bodies.length], { P, A } = sectionOf(beam.nodes, at[0]), axes = multiply(beam.A, A);
  return { r: add(add(beam.r, apply(beam.A, P)), apply(axes, [0, at[1], at[2]])), A: axes };
}

const moved = ({ r, A }, at) => ({ r: add(r, apply(A, at)), A });

// A point of I in the axes of a body.
export const pointIn = ({ r, A }, point) => turnedBack(A, subtract(point, r));

// Where a body's shape is nearest to a point, both in the body's axes; null where the body has none.
export function nearestOf({ shape, at, A, size }, point) {
  if (!shape) return null;
  const inside = turnedBack(A, subtract(point, at)).map((v, i) => Math.min(size[i] / 2, Math.max(-size[i] / 2, v)));
  return add(at, apply(A, inside));
}

// Corners of a body's shape in its axes, of a cylinder or a mesh those of the box about it.
export function cornersOf({ shape, at, A, size }) {
  const ends = [-0.5, 0.5];
  return shape ? ends.flatMap((x) => ends.flatMap((y) => ends.map((z) => add(at, apply(A, [x * size[0], y * size[1], z * size[2]]))))) : [];
}

// The triangles of a body's mesh in its axes.
export const meshOf = ({ at, A, triangles }) =>
  triangles.corners.map((row) => [0, 3, 6].map((k) => add(at, apply(A, row.slice(k, k + 3)))));

// Points in I about all of it.
export function outlineOf(mechanism, places) {
  const { bodies, beams, struts, feet, wheelRadius } = mechanism, at = (thing, point) => frameOf(mechanism, places, thing, point).r;
  return [
    ...bodies.flatMap((body, i) => [places.bodies[i].r, ...cornersOf(body).map((corner) => at(i, corner))]),
    ...beams.flatMap(({ length, radii }, i) => [0, length].flatMap((x) => [-1, 1].flatMap((side) =>
      [[x, side * radii[0], 0], [x, 0, side * radii[0]]].map((point) => at(bodies.length + i, point))))),
    ...struts.flatMap(({ ends, at: points }) => ends.map((thing, i) => at(thing, points[i]))),
    ...feet.map(({ on, at: point }) => at(on, point)),
    ...places.wheels.flatMap((r) => [-1, 1].flatMap((side) => [[0, side * wheelRadius, 0], [side * wheelRadius, 0, 0]].map((out) => add(r, out)))),
  ];
}

// What a picture moves with: the carrier, the body on wheels, or the free body at the root of what carries the tubes; null: the ground.
export function followedIn({ bodies, joints, feet, on, wheels, wheelsOn, carried }, places) {
  if (carried) return places.carrier.r;
  if (wheels.length > 0) return places.bodies[wheelsOn].r;
  let thing = on, joint = null;
  while (thing >= 0) {
    joint = joints.find(({ body, closes }) => body === thing && !closes);
    [thing, joint] = [joint.parent, joint];
  }
  const floats = joint?.kind === "free" && feet.length === 0;
  return floats ? (joint.body < bodies.length ? places.bodies[joint.body].r : places.beams[joint.body - bodies.length].r) : null;
}
