"""Scenes in three dimensions: the file read by a second reader, what it shows against columns."""

import json
import math
import os
import struct
import unittest

import launchdyn as ld
import numpy as np
from support import EXAMPLES, FIXED, Case, command

TYPES = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}


class Scene:
    """A binary glTF file, by the standard's text."""

    def __init__(self, path):
        data = path.read_bytes()
        magic, version, length, size = struct.unpack("<4sIII", data[:16])
        assert (magic, version, length) == (b"glTF", 2, len(data)), data[:16]
        assert data[16:20] == b"JSON" and data[20 + size + 4:28 + size] == b"BIN\0"
        self.json, self.bytes = json.loads(data[20:20 + size]), data[28 + size:]
        [scene] = self.json["scenes"]
        self.extras = scene["extras"]
        self.nodes = {node["name"]: i for i, node in enumerate(self.json["nodes"])}
        self.parent = {child: i for i, node in enumerate(self.json["nodes"])
                       for child in node.get("children", [])}
        assert sorted([*self.parent, *scene["nodes"]]) == list(range(len(self.nodes)))

    def numbers(self, accessor):
        about = self.json["accessors"][accessor]
        view = self.json["bufferViews"][about["bufferView"]]
        kind = {5125: "<u4", 5126: "<f4"}[about["componentType"]]
        raw = np.frombuffer(self.bytes, kind, view["byteLength"] // 4, view["byteOffset"])
        values = raw.reshape(about["count"], TYPES[about["type"]]).astype(float)
        if "min" in about:
            np.testing.assert_array_equal(values.min(0), np.float32(about["min"]))
            np.testing.assert_array_equal(values.max(0), np.float32(about["max"]))
        return values

    def channel(self, name, path):
        """Times and values of what moves; None for what does not."""
        [animation] = self.json["animations"]
        for channel in animation["channels"]:
            if channel["target"] == {"node": self.nodes[name], "path": path}:
                sampler = animation["samplers"][channel["sampler"]]
                return self.numbers(sampler["input"])[:, 0], self.numbers(sampler["output"])
        return None

    def local(self, name):
        """Places and rotations of a node in the axes of the one it belongs to, by key."""
        node = self.json["nodes"][self.nodes[name]]
        moved = self.channel(name, "translation")
        if moved is None:
            return np.array([node.get("translation", [0, 0, 0])], float), np.eye(3)[None]
        x, y, z, w = self.channel(name, "rotation")[1].T
        np.testing.assert_allclose(x * x + y * y + z * z + w * w, 1, rtol=1e-6)
        A = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                      [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                      [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
        return moved[1], np.moveaxis(A, 2, 0)

    def frame(self, name):
        r, A = self.local(name)
        if self.nodes[name] in self.parent:
            above = self.json["nodes"][self.parent[self.nodes[name]]]["name"]
            r0, A0 = self.frame(above)
            return r0 + np.einsum("kij,kj->ki", A0, r + 0 * r0), A0 @ A
        return r, A

    def corners(self, name):
        """Of a bending node: its corners by key, in its own axes."""
        mesh = self.json["nodes"][self.nodes[name]]["mesh"]
        [primitive] = self.json["meshes"][mesh]["primitives"]
        still = self.numbers(primitive["attributes"]["POSITION"])
        moved = [self.numbers(target["POSITION"]) for target in primitive["targets"]]
        weights = self.channel(name, "weights")[1].reshape(-1, len(moved))
        self.weights = weights
        return still + np.tensordot(weights, moved, 1)


def rows(result, scene):
    """Rows of a history at the keys of the launch."""
    times = scene.channel("launcher", "translation")[0] / scene.extras["slower"]
    t = result["t"]
    first = result["t"][result["t"] >= scene.extras["from"] + result["t"][0] * 0 - 1e-9][0]
    at = np.searchsorted(t, first + times - 1e-7)
    np.testing.assert_allclose(t[at] - first, times, atol=2e-7)
    return at


class Scenes(Case):
    def scene(self, scenario, **more):
        result = scenario.run(out=self.folder / "out")
        ld.draw(self.folder / "scene.glb", self.folder / "out", **more)
        return result, Scene(self.folder / "scene.glb")

    def tip(self, scene):
        """The middle of the tube's last ring in the undeformed tube's frame, its normal."""
        r, A = scene.local("tube")
        ring = scene.corners("tube")[:, -24:]
        at = r + np.einsum("kij,kj->ki", A, ring.mean(1))
        normal = np.cross(ring[:, 6] - ring[:, 18], ring[:, 0] - ring[:, 12])
        normal = np.einsum("kij,kj->ki", A, -normal / np.linalg.norm(normal, axis=1)[:, None])
        return at, normal * np.sign(normal[:, :1])

    def test_the_tube_bends_as_its_columns_say(self):
        # gravity is not in the plane of a bending axis, and the planes differ
        result, scene = self.scene(ld.Scenario.read(FIXED), start=0.05, slower=30)
        at = rows(result, scene)
        self.assertEqual(scene.extras["slower"], 30)
        self.assertAlmostEqual(scene.extras["from"], 0.05, delta=2e-4)
        (r, normal), tip = self.tip(scene), {n: result[f"tip.{n}"][at] for n in
                                             ("y", "z", "pitch", "yaw")}
        self.near("tip's deflection [m]", r[:, 1:], np.transpose([tip["y"], tip["z"]]), 2e-10)
        self.near("its slopes [rad]", normal[:, 1:],
                  np.transpose([tip["pitch"], -tip["yaw"]]), 5e-8)
        self.assertGreater(np.ptp(tip["y"]), 1e-4)
        self.assertGreater(np.ptp(tip["z"]), 1e-5)
        self.assertLessEqual(np.max(np.abs(scene.weights)), 1)
        self.check_rocket(result, scene, at)

    def check_rocket(self, result, scene, at, turns=3e-4):
        inside = at[np.isfinite(result["rocket.s"][at])]
        r, A = scene.frame("rocket 1")
        pitch, yaw = np.arcsin(A[:, 1, 0]), np.arctan2(-A[:, 2, 0], A[:, 0, 0])
        for name, found in (("pitch", pitch), ("yaw", yaw)):
            self.near(f"rocket's {name} [rad]", found, result[f"rocket.{name}"][inside], 1e-7)
        velocity = np.gradient(r, result["t"][inside], axis=0)
        self.near("rocket's velocity by its places (relative)",
                  velocity[5:-5, 0] / result["rocket.vx"][inside][-1],
                  result["rocket.vx"][inside][5:-5] / result["rocket.vx"][inside][-1], turns)

    def test_a_guide_that_is_not_straight(self):
        result, scene = self.scene(ld.Scenario.read(FIXED, {"tubes.initial_shape": {
            "offsets": [["0 m", "0 mm", "0 mm"], ["1.5 m", "0.4 mm", "-0.3 mm"],
                        ["3 m", "1 mm", "0.5 mm"]]}}))
        at = rows(result, scene)
        (r, _), by = self.tip(scene), np.array([1e-3, 0.5e-3])
        # the tube's roll turns the initial offset
        self.near("deflection of a bent guide's tip [m]", r[:, 1:] - by,
                  np.transpose([result["tip.y"][at], result["tip.z"][at]]), 1e-6)
        self.check_rocket(result, scene, at, turns=1e-3)

    def test_magnified_deflections(self):
        result, scene = self.scene(ld.Scenario.read(FIXED), magnify=10)
        at = rows(result, scene)
        r, _ = self.tip(scene)
        tip = np.transpose([result["tip.y"][at], result["tip.z"][at]])
        self.near("10 times the tip's deflection (relative)", r[:, 1:] / np.max(np.abs(tip)) / 10,
                  tip / np.max(np.abs(tip)), 3e-3)

    def test_a_vehicle_and_a_flight(self):
        result, scene = self.scene(ld.Scenario.read(EXAMPLES / "reference.yaml", {
            "base.speed": "5 km/h", "run.lead_in": "0.3 s"}), start=-0.25, end=1)
        at = rows(result, scene)
        for name in ("front-left", "rear-right"):
            r, _ = scene.frame(f"wheel {name}")
            self.near(f"wheel {name} [m]", r, np.transpose(
                [result[f"wheel.{name}.{axis}"][at] for axis in "xyz"]), 3e-7)
        self.check_pose(result, scene, at, "chassis")
        [flight] = result.flights.values()
        times, r = scene.channel("rocket 1 in flight", "translation")
        _, A = scene.frame("rocket 1 in flight")
        self.assertAlmostEqual(times[-1], 1.25, delta=0.05)
        last = scene.frame("rocket 1")[0][-1]
        self.near("where the tube's node hands the rocket over [m]", r[0], last, 2e-2)
        centre = [flight[f"center.{k}"][0] for k in "xyz"]
        there = r[-1] + np.linalg.norm(r[0] - centre) * A[-1, :, 0]
        row = np.searchsorted(flight["t"], result["t"][at][0] + times[-1] - 1e-6)
        self.near("mass centre in flight [m]", there, [flight[f"center.{k}"][row] for k in "xyz"],
                  1e-5)
        self.assertEqual(scene.channel("rocket 1", "scale")[1][:, 0].tolist(), [1, 0])
        self.assertEqual(scene.channel("rocket 1 in flight", "scale")[1][:, 0].tolist(), [0, 1])

    def check_pose(self, result, scene, at, name):
        r, A = scene.frame(name)
        self.near(f"{name} [m]", r, np.transpose([result[f"{name}.{k}"][at] for k in "xyz"]), 3e-7)
        yaw, pitch, roll = (result[f"{name}.{k}"][at] for k in ("yaw", "pitch", "roll"))
        level = np.cos(pitch)
        nose = np.transpose([np.cos(yaw) * level, np.sin(pitch), -np.sin(yaw) * level])
        self.near(f"{name}'s x axis [1]", A[:, :, 0], nose, 3e-7)
        self.near(f"{name}'s y axis along y [1]", A[:, 1, 1], np.cos(pitch) * np.cos(roll), 3e-7)
        self.near(f"{name}'s z axis along y [1]", A[:, 1, 2], -np.cos(pitch) * np.sin(roll), 3e-7)

    def test_tubes_take_turns(self):
        result, scene = self.scene(ld.Scenario.read(FIXED, {
            "firing.order": [8, 3], "firing.interval": "0.3 s"}), start=0, end=0.5)
        at = rows(result, scene)
        r, _ = scene.frame("tube")
        for name, shown, row in (("tube 8", [0, 1], 0), ("tube 3", [1, 0], -1)):
            self.assertEqual(scene.channel(name, "scale")[1][:, 0].tolist(), shown)
            self.near(f"{name} is where it launches [m]", r[row], scene.frame(name)[0][row], 1e-4)
        self.assertEqual(len([name for name in scene.nodes if name.startswith("tube ")]), 18)
        self.assertLess(result["t"][at][0], 1e-3)
        self.assertEqual(scene.channel("rocket 2", "scale")[1][:, 0].tolist()[:2], [0, 1])

    def test_bodies_of_a_mechanism(self):
        result, scene = self.scene(ld.Scenario.read(EXAMPLES / "multibody/mast.yaml"), end=0.1)
        at = rows(result, scene)
        names = result.history.columns
        bodies = [name[:-4] for name in names if name.startswith(("body.", "beam."))
                  and name.endswith(".yaw")]
        self.assertGreater(len([name for name in bodies if name.startswith("beam.")]), 0)
        for name in bodies:
            self.check_pose(result, scene, at, name)

    def test_what_is_refused(self):
        ld.Scenario.read(FIXED).run(out=self.folder / "out")
        to = self.folder / "scene.glb"
        for more, said in (({"figures": ["tip"]}, "not for a scene"), ({"style": "paper"}, "scene"),
                           ({"magnify": 0}, "found magnify 0"), ({"slower": -1}, "found slower -1"),
                           ({"start": 3.0}, "no row between")):
            with self.assertRaisesRegex(ld.InputError, said):
                ld.draw(to, self.folder / "out", **more)
        with self.assertRaisesRegex(ld.InputError, "one run, found 2"):
            ld.draw(to, self.folder / "out", self.folder / "out")
        with self.assertRaisesRegex(ld.InputError, "are for a scene"):
            ld.draw(self.folder / "x.svg", self.folder / "out", magnify=2)
        self.assertFalse(to.exists())
        command("plot", self.folder / "out", "--magnify", "2", "-o", to)
        self.assertEqual(Scene(to).extras, {"from": 0, "slower": 1, "magnified": 2})

    if os.environ.get("LD_VTK"):  # scripts/prove, which installs VTK
        def test_vtk_shows_the_same(self):
            from vtkmodules.util.numpy_support import vtk_to_numpy
            from vtkmodules.vtkIOGeometry import vtkGLTFReader
            result, scene = self.scene(ld.Scenario.read(FIXED), slower=100)
            reader = vtkGLTFReader()
            reader.SetFileName(str(self.folder / "scene.glb"))
            reader.SetApplyDeformationsToGeometry(True)
            reader.UpdateInformation()
            self.assertEqual(reader.GetNumberOfAnimations(), 1)
            reader.SetFrameRate(20)
            reader.EnableAnimation(0)
            reader.UpdateInformation()
            reader.UpdateTimeStep(9.0)
            blocks, points = [reader.GetOutputDataObject(0)], []
            while blocks:
                block = blocks.pop()
                if hasattr(block, "GetNumberOfBlocks"):
                    blocks += [block.GetBlock(i) for i in range(block.GetNumberOfBlocks())]
                elif block:
                    points.append(vtk_to_numpy(block.GetPoints().GetData()))
            times = scene.channel("launcher", "translation")[0]
            key = np.argmin(np.abs(times - 9.0))
            (r, A), ours = scene.frame("tube"), scene.corners("tube")
            expected = r[key] + ours[key] @ A[key].T
            [theirs] = [p for p in points if len(p) == len(expected)]
            self.near("corners of the tube in VTK [m]", theirs, expected, 1e-6)
            self.assertTrue(math.isfinite(result["tip.y"][0]))


if __name__ == "__main__":
    unittest.main()
