# SPDX-License-Identifier: Apache-2.0
"""NIfTI files by nibabel, and one head in three formats."""
import numpy as np

from .cases import TYPES, rotation, values_of


def to_lps(affine):
    """Steps and origin of a RAS affine, in LPS."""
    turned = np.diag([-1, -1, 1]) @ affine[:3]
    return turned[:, :3].T, turned[:, 3]


def nibabel_files(cases):
    import nibabel as nib
    oblique = np.eye(4)
    oblique[:3, :3] = rotation(.4, .1, -.7) @ np.diag([1.5, .75, 3])
    oblique[:3, 3] = -40, 25, 7
    mirrored = oblique @ np.diag([-1, 1, 1, 1])
    number = 0
    for make, name in ((nib.Nifti1Image, "one"), (nib.Nifti2Image, "two"), (nib.Nifti1Pair, "pair"),
                       (nib.Nifti2Pair, "pair2")):
        for kind in TYPES:
            for endian in "<>":
                for affine in (oblique, mirrored):
                    array = values_of(kind, (6, 5, 4), seed=number)  # [x, y, z]
                    header = make.header_class(endianness=endian)
                    header.set_data_dtype(array.dtype.newbyteorder(endian))
                    image = make(array, affine, header)
                    image.header.set_slope_inter(1, 0)
                    suffix = ".img" if "pair" in name else ".nii"
                    file = f"{name}{number}{suffix}{'.gz' if number % 3 == 0 else ''}"
                    number += 1
                    nib.save(image, cases.path(file))
                    back = nib.load(cases.path(file))
                    steps, origin = to_lps(back.affine)
                    stored = np.asanyarray(back.dataobj.get_unscaled()).T
                    cases.add(file, stored.astype(stored.dtype.newbyteorder("=")), steps, origin)
                    if "pair" in name:
                        other = file.replace(".img", ".hdr")
                        cases.add(other, stored.astype(stored.dtype.newbyteorder("=")), steps, origin)
    one_head(cases, nib, oblique)
    # qform alone, sform alone, both (sform counts), neither.
    array = values_of("uint8", (6, 5, 4), seed=99)
    for sform, qform, name in ((0, 1, "q"), (1, 0, "s"), (2, 1, "both"), (0, 0, "none")):
        for affine, hand in ((oblique, "right"), (mirrored, "left")):
            image = nib.Nifti1Image(array, None)
            image.header.set_zooms((1.5, .75, 3))
            if qform:
                image.header.set_qform(affine @ np.diag([1, 1, 1, 1]), qform)
            if sform:
                moved = affine.copy()
                moved[:3, 3] += 5
                image.header.set_sform(moved, sform)
            file = f"{name}_{hand}.nii"
            nib.save(nib.Nifti1Image(array, None, image.header), cases.path(file))
            header = nib.load(cases.path(file)).header
            if sform:
                steps, origin = to_lps(header.get_sform())
            elif qform:
                steps, origin = to_lps(header.get_qform())
            else:
                steps, origin = np.diag([1.5, .75, 3]), (0, 0, 0)
            cases.add(file, array.T, steps, origin, lps=bool(sform or qform))
    # Scaled samples, by the tool's own arithmetic in double precision.
    for slope, inter, drawn in ((2, -1024, "int16"), (.1, 3.5, "float"), (1, 70000, "float"), (-1, 255, "uint8")):
        array = np.arange(120, dtype=np.uint8).reshape(6, 5, 4)
        image = nib.Nifti1Image(array, oblique)
        image.header.set_slope_inter(slope, inter)
        file = f"scaled_{drawn}_{slope}.nii.gz"
        image.to_filename(cases.path(file))
        raw = bytearray(__import__("gzip").open(cases.path(file)).read())
        raw[112:120] = np.array([slope, inter], "<f4").tobytes()  # nibabel resets them when it writes
        raw[352:] = array.tobytes(order="F")
        with __import__("gzip").open(cases.path(file), "wb") as out:
            out.write(bytes(raw))
        back = nib.load(cases.path(file))
        steps, origin = to_lps(back.affine)
        cases.add(file, back.get_fdata().T, steps, origin, drawn=drawn)
    times = values_of("int16", (6, 5, 4, 3), seed=7)
    nib.save(nib.Nifti1Image(times, oblique), cases.path("times.nii.gz"))
    steps, origin = to_lps(nib.load(cases.path("times.nii.gz")).affine)
    cases.add("times.nii.gz", times[..., 0].T, steps, origin, warnings=["time 0 of 3 is taken"])
    cases.add("times.nii.gz", times[..., 2].T, steps, origin, time=2)
    vectors = values_of("float32", (6, 5, 4, 1, 3), seed=8)
    nib.save(nib.Nifti1Image(vectors, oblique), cases.path("vectors.nii"))
    cases.add("vectors.nii", vectors[..., 0, 1].T, steps, origin, channel=1)
    rgb = np.zeros((6, 5, 4), dtype=[("R", "u1"), ("G", "u1"), ("B", "u1")])
    for i, key in enumerate("RGB"):
        rgb[key] = values_of("uint8", (6, 5, 4), seed=20 + i)
    nib.save(nib.Nifti1Image(rgb, oblique), cases.path("rgb.nii"))
    cases.add("rgb.nii", rgb["G"].T, steps, origin, channel=1)

    bad_places(cases, nib)
    labels(cases, nib, oblique)


def labels(cases, nib, affine):
    """Segmentations (intent 1002) that are scaled: by the writer of the file, and by nibabel for a smaller type."""
    numbers = np.add.outer(np.arange(12) // 3 * 2, np.arange(10) // 5)[:, :, None].repeat(8, 2).astype("f8")  # 0 to 7

    def save(file, stored, kind=None):
        image = nib.Nifti1Image(stored, affine)
        image.header.set_intent("label")
        if kind:
            image.set_data_dtype(kind)
        nib.save(image, cases.path(file))
        return nib.load(cases.path(file))

    back = save("labels_auto.nii.gz", numbers, "uint8")
    assert back.dataobj.slope not in (1, None) and np.abs(back.get_fdata() - numbers).max() > 0
    steps, origin = to_lps(back.affine)
    cases.add("labels_auto.nii.gz", numbers.T, steps, origin, drawn="uint8",
              warnings=["its samples are labels, as intent_code 1002 says", "are the nearest whole numbers"])
    far = numbers * 1e6
    far[far == 0] = -1
    save("labels_far.nii", far.astype("i4"))
    codes = np.unique(far, return_inverse=True)[1].reshape(far.shape).astype("u1")
    cases.add("labels_far.nii", codes.T, steps, origin, warnings=["its 8 labels, from -1 to 7000000"])
    halves = numbers / 2
    save("labels_halves.nii", halves.astype("f4"))
    cases.add("labels_halves.nii", halves.T, steps, origin, drawn="float", warnings=["no whole numbers"])


def bad_places(cases, nib):
    """Skewed and empty sforms, and pixdim that are no distances."""
    array = values_of("int16", (6, 5, 4), seed=60)
    good = rotation(.4, .1, -.7) @ np.diag([1.5, .75, 3])

    def case(file, sform, sform_code, qform_code, expected, says):
        image = nib.Nifti1Image(array, None)
        affine = np.eye(4)
        affine[:3, :3], affine[:3, 3] = good, (-40, 25, 7)
        image.header.set_qform(affine, 1)
        image.header["qform_code"] = qform_code
        for row, name in zip(sform, ("srow_x", "srow_y", "srow_z")):
            image.header[name] = row
        image.header["sform_code"] = sform_code
        nib.save(nib.Nifti1Image(array, None, image.header), cases.path(file))
        header = nib.load(cases.path(file)).header
        steps, origin = to_lps(header.get_qform() if expected is None else expected)
        cases.add(file, array.T, steps, origin, warnings=says)

    place = np.array([[1], [2], [3.]])
    skewed = np.hstack([good @ np.array([[1, .01, 0], [0, 1, 0], [0, 0, 1]]), place])  # by .57 degrees
    case("skewed.nii", skewed, 2, 1, None, ["expected 90: the qform is taken"])
    case("empty.nii", np.zeros((3, 4)), 1, 1, None, ["distance of 0", "the qform is taken"])
    # A shear of 1e-4 (.0057 degrees): the orthogonal directions nearest to it, by singular values.
    sheared = good @ np.array([[1, 1e-4, 0], [0, 1, 0], [0, 0, 1]])
    lengths = np.linalg.norm(sheared, axis=0)
    left, _, right = np.linalg.svd(sheared / lengths)
    nearest = np.eye(4)
    nearest[:3] = np.hstack([left @ right * lengths, place])
    case("sheared.nii", np.hstack([sheared, place]), 1, 0, nearest, ["nearest orthogonal ones are taken"])
    image = nib.Nifti1Image(array, None)
    nib.save(image, cases.path("pixdim.nii"))
    with open(cases.path("pixdim.nii"), "r+b") as file:
        file.seek(80)  # pixdim[1], [2], [3], which nibabel would mend
        file.write(np.array([-1.5, 0, 3], "<f4").tobytes())
        file.seek(252)
        file.write(np.zeros(2, "<i2").tobytes())
    cases.add("pixdim.nii", array.T, np.diag([1.5, 1, 3]), warnings=["pixdim[1]: found -1.5", "pixdim[2]: found 0"])


def one_head(cases, nib, affine):
    """Writes samples at the same places as NIfTI (RAS), NRRD and MetaImage (LPS)."""
    array = values_of("int16", (6, 5, 4), seed=50)
    nib.save(nib.Nifti1Image(array, affine), cases.path("head.nii.gz"))
    steps, origin = to_lps(nib.load(cases.path("head.nii.gz")).affine)
    lengths = np.linalg.norm(steps, axis=1)

    def text(vector):
        return ",".join(repr(float(x)) for x in vector)

    with open(cases.path("head.nrrd"), "wb") as out:
        out.write(("NRRD0004\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: 6 5 4\nspace directions: " +
                   " ".join(f"({text(step)})" for step in steps) + "\nendian: little\nencoding: raw\nspace origin: (" +
                   text(origin) + ")\n\n").encode() + array.tobytes(order="F"))
    with open(cases.path("head.mha"), "wb") as out:
        rows = (steps / lengths[:, None]).ravel()
        out.write(("ObjectType = Image\nNDims = 3\nTransformMatrix = " + text(rows).replace(",", " ") + "\nOffset = " +
                   text(origin).replace(",", " ") + "\nAnatomicalOrientation = RAI\nElementSpacing = " +
                   text(lengths).replace(",", " ") + "\nDimSize = 6 5 4\nElementType = MET_SHORT\n" +
                   "ElementDataFile = LOCAL\n").encode() + array.tobytes(order="F"))
    for file in ("head.nii.gz", "head.nrrd", "head.mha"):
        cases.add(file, array.T, steps, origin, lps=True)
