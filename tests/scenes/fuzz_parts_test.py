# SPDX-License-Identifier: Apache-2.0
"""The judge of random scenes is judged: python3 fuzz_parts_test.py LAMINA. Exit code 77 without numpy."""
import itertools
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
try:
    import numpy
except ModuleNotFoundError:
    sys.exit(77)
from fuzz_parts import delaunay, emission, scene_maker, transfer  # noqa: E402
from fuzz_parts.dice import Dice  # noqa: E402
from fuzz_parts.judge import Judge  # noqa: E402

LAMINA = pathlib.Path(sys.argv.pop(1)).resolve()


def piece(scalars, length):
    return emission.Pieces(numpy.zeros(1, int), numpy.zeros(1), numpy.array([length]), numpy.array([scalars], float))


def point(value, color, extinction):
    return {"value": value, "color": color, "extinction": extinction}


def findings(seed):
    with tempfile.TemporaryDirectory() as folder:
        verdict = Judge(scene_maker.make(seed), LAMINA, pathlib.Path(folder), 60).run()
    return {finding.kind for finding in verdict.findings}


class Emission(unittest.TestCase):
    def test_a_homogeneous_piece_is_in_closed_form(self):
        for depth in (1e-8, 0.3, 20, 1e7):
            optics = transfer.Optics({"points": [point(0, [0.25, 1, 4], depth / 2)]})
            found, _ = emission.integrate(piece([3, 3, 3, 3], 2.0), optics, 1)
            alpha = -numpy.expm1(-depth)
            # Gauss's rule of 8 nodes over depths up to .5: far below rounding, of at most some 100 pieces.
            numpy.testing.assert_allclose(found[0], alpha * numpy.array([0.25, 1, 4, 1]), rtol=1e-13)

    def test_a_peak_that_a_cubic_crosses(self):
        """Against the midpoint rule of 2^20 steps, which is off by the square of a step over the peak's width: its quarter
        is 2^-20 / 1e-3 of it, so some 1e-6 of what is found."""
        optics = transfer.Optics({"points": [point(0.3, [1, 0, 0], 0), point(0.301, [0, 1, 0], 900),
                                             point(0.302, [0, 0, 1], 0)]})
        bernstein = numpy.array([0.1, 0.9, -0.2, 0.5])
        found, doubt = emission.integrate(piece(bernstein, 1.5), optics, 1)
        t = (numpy.arange(1 << 20) + 0.5) / (1 << 20)
        basis = [(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t ** 3]
        looks = optics.at(sum(b * f for b, f in zip(bernstein, basis)))
        depths = looks[:, 3] * 1.5 / (1 << 20)
        before = numpy.cumsum(depths) - depths
        wanted = ((numpy.exp(-before) * -numpy.expm1(-depths))[:, None] * looks[:, :3]).sum(0)
        numpy.testing.assert_allclose(found[0, :3], wanted, atol=4e-6)
        self.assertLess(doubt[0], 1e-9)


class Delaunay(unittest.TestCase):
    def test_spheres_are_empty_and_faces_have_two_sides(self):
        for seed in range(5):
            dice = Dice(seed)
            points = sorted({tuple(dice.whole(0, 1000) for _ in range(3)) for _ in range(14)})
            tets = delaunay.tetrahedra(points)
            self.assertGreater(len(tets), 8)
            faces = [tuple(sorted(face)) for tet in tets for face in itertools.combinations(tet, 3)]
            self.assertLessEqual(max(map(faces.count, faces)), 2)
            for tet in tets:
                corners = [points[i] for i in tet]
                self.assertGreater(delaunay.orientation(*corners), 0)
                self.assertFalse(any(delaunay.in_sphere(corners, point) > 0 for point in points))


class Scenes(unittest.TestCase):
    def test_a_seed_is_a_scene(self):
        for seed in range(20):
            one, other = scene_maker.make(seed), scene_maker.make(seed)
            self.assertEqual((one.scene, one.files, one.arguments), (other.scene, other.files, other.arguments))

    def test_blocks_of_whole_numbers_are_no_labels(self):
        """lamina takes this volume for labels unless the scene says that it is a field, as the oracle draws it."""
        self.assertEqual(findings(20491), set())

    def test_a_wrong_judge_finds_that_the_tracer_is_wrong(self):
        """So a wrong tracer would be found: extinction 1e-3 too high moves every channel of a pixel that is neither clear
        nor opaque by far more than the tracer's 1e-7."""
        exact = transfer.Optics.__init__

        def denser(optics, spec):
            exact(optics, spec)
            optics.at_low, optics.at_high = (side * [1, 1, 1, 1.001] for side in (optics.at_low, optics.at_high))

        transfer.Optics.__init__ = denser
        try:
            found = [seed for seed in range(1, 13) if "tracer" in findings(seed)]
        finally:
            transfer.Optics.__init__ = exact
        # Pictures that show nothing, or are opaque in one colour, do not tell.
        self.assertGreaterEqual(len(found), 6)


if __name__ == "__main__":
    unittest.main()
