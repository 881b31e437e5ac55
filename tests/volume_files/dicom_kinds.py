# SPDX-License-Identifier: Apache-2.0
"""Kinds of DICOM files as scanners and other programs write them: what they say of places, phases, scales and of
what is no slice. array_oracle.py calls kinds_of_dicom(itself); its cases are compared there.
"""
import copy
import os
import struct

import numpy as np
from pydicom import dcmread
from pydicom.dataset import Dataset
from pydicom.sequence import Sequence
from pydicom.uid import ExplicitVRLittleEndian, ImplicitVRLittleEndian, RLELossless, generate_uid

AXIAL = ([1, 0, 0], [0, 1, 0])
OBLIQUE = (np.array([2, 1, 2]) / 3, np.array([-2, 2, 1]) / 3)
SPACING, ORIGIN = (.9, .7, 2.5), (-10, -20, -30)
SERIES = "1.2.1"


def steps_of(axes=AXIAL, spacing=SPACING):
    return [np.asarray(axes[0]) * spacing[0], np.asarray(axes[1]) * spacing[1], np.cross(*axes) * spacing[2]]


class Kinds:
    def __init__(self, oracle):
        self.oracle = oracle

    def case(self, name, values, axes=AXIAL, origin=ORIGIN, says=(), spacing=SPACING, unit="mm", path=None, **request):
        self.oracle.case(name, path or name, values, steps_of(axes, spacing), origin, **request)
        self.oracle.CASES[-1].update({"says": list(says), "unit": unit})

    def bad(self, name, *words, path=None, **request):
        self.oracle.bad(name, path or name, *words, **request)

    def stack(self, array, axes=AXIAL, **how):
        return self.oracle.stack(array, SERIES, *axes, SPACING, ORIGIN, **how)

    def frames(self, array, axes=AXIAL, **how):
        """One file with several frames, and no places but the first one's."""
        return self.oracle.slice_of(array, SERIES, 1, ORIGIN, [*axes[0], *axes[1]], SPACING, **how)

    def save(self, name, slices):
        self.oracle.save_slices(name, slices)

    def whole(self, shape=(8, 10, 12), dtype="<i2"):
        return self.oracle.samples(dtype, shape)

    def dose_cases(self):
        array = self.whole(dtype="<u4")
        up = 2.5 * np.arange(8)

        def dose(name, offsets, axes=AXIAL):
            data = self.frames(array, axes)
            data.Modality, data.FrameIncrementPointer, data.DoseGridScaling = "RTDOSE", 0x3004000c, "1.5e-05"
            data.GridFrameOffsetVector = [f"{v:.6g}" for v in offsets]
            del data.SliceThickness
            self.save(name, [data])

        values = array * 1.5e-5
        dose("dcm_dose", up)
        self.case("dcm_dose", values)
        dose("dcm_dose_oblique", up, OBLIQUE)
        self.case("dcm_dose_oblique", values, OBLIQUE)
        # Frame k lies at z = -30 - 2.5 k: from the lowest on, the frames are in reverse.
        dose("dcm_dose_falling", -up)
        self.case("dcm_dose_falling", values[::-1], origin=(-10, -20, -47.5))
        dose("dcm_dose_absolute", up - 30)
        self.case("dcm_dose_absolute", values)
        dose("dcm_dose_uneven", np.where(up == 10, 11, up))
        self.bad("dcm_dose_uneven", "GridFrameOffsetVector", "3.5 mm between frame 4", "expected 2.5")
        dose("dcm_dose_elsewhere", up + 5)
        self.bad("dcm_dose_elsewhere", "GridFrameOffsetVector", "found 5", "-30")
        dose("dcm_dose_short", up[:-1])
        self.bad("dcm_dose_short", "GridFrameOffsetVector", "found 7", "expected 8")

    def enhanced(self, frames, positions, times=None, own=(), slopes=None, orientations=None, **how):
        """An enhanced image. `own`: groups that each frame has instead of all; `slopes`: of each frame."""
        data = self.frames(np.stack(frames), **how)
        del data.ImagePositionPatient, data.ImageOrientationPatient, data.PixelSpacing, data.SliceThickness
        measures, orientation = Dataset(), Dataset()
        measures.PixelSpacing, measures.SliceThickness = [SPACING[1], SPACING[0]], SPACING[2]
        orientation.ImageOrientationPatient = [1, 0, 0, 0, 1, 0]
        groups = {"PixelMeasuresSequence": measures, "PlaneOrientationSequence": orientation}
        shared = Dataset()
        for word, group in groups.items():
            if word not in own:
                setattr(shared, word, Sequence([group]))
        items = []
        for i, position in enumerate(positions):
            item, plane, content = Dataset(), Dataset(), Dataset()
            for word in own:
                setattr(item, word, Sequence([copy.deepcopy(groups[word])]))
            plane.ImagePositionPatient = [f"{v:.10g}" for v in position]
            item.PlanePositionSequence = Sequence([plane])
            content.StackID = "1"
            if times is not None:
                content.DimensionIndexValues = times[i]
            item.FrameContentSequence = Sequence([content])
            if slopes is not None:
                value = Dataset()
                value.RescaleSlope, value.RescaleIntercept, value.RescaleType = *slopes[i], "HU"
                item.PixelValueTransformationSequence = Sequence([value])
            items.append(item)
        data.SharedFunctionalGroupsSequence = Sequence([shared])
        data.PerFrameFunctionalGroupsSequence = Sequence(items)
        return data

    def enhanced_cases(self):
        array = self.whole()
        places = [(-10, -20, -30 + 2.5 * i) for i in range(8)]
        scales = [(2 + .5 * i, i - 100) for i in range(8)]
        values = [image * scale[0] + scale[1] for image, scale in zip(array, scales)]
        self.save("dcm_enh_slopes", [self.enhanced(array, places, slopes=scales)])
        self.case("dcm_enh_slopes", values)
        order = [3, 1, 0, 7, 2, 5, 4, 6]
        for name, how in (("", {}), ("_implicit", {"syntax": ImplicitVRLittleEndian}),
                          ("_rle", {"syntax": RLELossless})):
            name = "dcm_enh_order" + name
            self.save(name, [self.enhanced([array[i] for i in order], [places[i] for i in order],
                                           own=["PlaneOrientationSequence", "PixelMeasuresSequence"], **how)])
            self.case(name, array)
        # Two times, one behind the other and in turn; the second time has the slices in reverse.
        both = [*array, *array[::-1]]
        numbers = [[1 + i // 8, 1 + i % 8] for i in range(16)]
        for word, turn in (("blocks", range(16)), ("turn", [i // 2 + 8 * (i % 2) for i in range(16)])):
            data = self.enhanced([both[i] for i in turn], [places[i % 8] for i in turn], [numbers[i] for i in turn],
                                 syntax=RLELossless if word == "turn" else ImplicitVRLittleEndian)
            name = f"dcm_enh_{word}"
            self.save(name, [data])
            self.case(name, array, says=["the first of DimensionIndexValues", "time 0 of 2"])
            self.case(name + "_1", array[::-1], path=name, says=["the first of DimensionIndexValues"], time=1)
            for item, number in zip(data.PerFrameFunctionalGroupsSequence, turn):
                item.FrameContentSequence[0].TemporalPositionIndex = 2 - number // 8  # the other way round
            self.save(name + "_index", [data])
            self.case(name + "_index", array[::-1], says=["TemporalPositionIndex"])
        nothing = self.enhanced(both, [*places, *places])
        self.save("dcm_enh_nothing", [nothing])
        self.bad("dcm_enh_nothing", "found 2 images at the place of frame 1 of", "nothing tells apart")
        few = self.enhanced(array, places)
        del few.PerFrameFunctionalGroupsSequence[3].PlanePositionSequence
        self.save("dcm_enh_few", [few])
        self.bad("dcm_enh_few", "ImagePositionPatient", "for 7 frames", "all 8")
        few.PerFrameFunctionalGroupsSequence.pop()
        self.save("dcm_enh_fewer", [few])
        self.bad("dcm_enh_fewer", "PerFrameFunctionalGroupsSequence", "found 7", "expected 8")
        halves = [self.enhanced(array[i:i + 4], places[i:i + 4]) for i in (4, 0)]
        self.save("dcm_enh_files", halves)
        self.case("dcm_enh_files", array)

    def phase_cases(self):
        first, second = self.whole(), self.whole()
        tags = {"TemporalPositionIdentifier": (1, 2), "TriggerTime": ("0", "412.5"), "AcquisitionNumber": (3, 4),
                "EchoNumbers": (1, 2), "EchoTime": ("9.5", "12.25"), "AcquisitionTime": ("093015.25", "093115"),
                "InversionTime": ("100", "350"), "FlipAngle": ("5", "20")}
        for rank, (word, values) in enumerate(tags.items()):
            slices = []
            for phase, array in enumerate((first, second)):
                slices += self.stack(array)
                for data in slices[-8:]:
                    setattr(data, word, values[phase])
                    for later in list(tags)[rank + 1:]:  # these do not count
                        setattr(data, later, tags[later][1 - phase])
            name = f"dcm_by_{word}"
            self.save(name, slices)
            self.case(name, first, says=[f"{word} tells", "time 0 of 2"])
            self.case(name + "_1", second, path=name, says=[f"{word} tells"], time=1)
        # Heart beats differ: each place has times of its own.
        slices = self.stack(first) + self.stack(second)
        for i, data in enumerate(slices):
            data.TriggerTime = str(400 * (i // 8) + 7 * (i % 3))
        self.save("dcm_beats", slices)
        self.case("dcm_beats", second, says=["TriggerTime"], time=1)
        # Two echoes of two times: only both numbers tell them apart.
        arrays = [self.whole() for _ in range(4)]
        slices = []
        for i, array in enumerate(arrays):
            slices += self.stack(array)
            for data in slices[-8:]:
                data.AcquisitionNumber, data.EchoNumbers = 1 + i // 2, 1 + i % 2
        self.save("dcm_echoes", slices)
        self.case("dcm_echoes", arrays[2], says=["AcquisitionNumber and EchoNumbers"], time=2)
        slices = self.stack(first) + self.stack(second)
        for i, data in enumerate(slices):
            data.InstanceNumber = 2 * (i % 8) + i // 8
        self.save("dcm_by_numbers", slices)
        self.case("dcm_by_numbers", second, says=["InstanceNumber"], time=1)
        self.save("dcm_nothing", self.stack(first) + self.stack(second))
        self.bad("dcm_nothing", "found 2 images", "nothing tells apart", "TemporalPositionIdentifier", "AcquisitionTime")
        self.save("dcm_uneven", (self.stack(first) + self.stack(second))[:-1])
        self.bad("dcm_uneven", "found 1 images", "expected as many")

    def place_cases(self):
        array = self.whole()
        bare = self.stack(array)
        for data in bare:
            del data.PixelSpacing
        self.save("dcm_nops", bare)
        self.case("dcm_nops", array, says=["no PixelSpacing (1 is taken"], spacing=(1, 1, 2.5), unit="")
        for data in bare:
            data.PixelAspectRatio = [3, 2]  # height, width
        self.save("dcm_ratio", bare)
        self.case("dcm_ratio", array, says=["PixelAspectRatio"], spacing=(1, 1.5, 2.5), unit="")
        for word in ("NominalScannedPixelSpacing", "ImagerPixelSpacing"):
            for data in bare:
                setattr(data, word, [.7, .9])
            self.save("dcm_" + word, bare)
            self.case("dcm_" + word, array, says=[f"no PixelSpacing ({word} is taken"])
        regions = [Dataset(), Dataset()]
        for data in bare:
            del data.NominalScannedPixelSpacing, data.ImagerPixelSpacing
            data.SequenceOfUltrasoundRegions = Sequence(regions)
        for region in regions:
            region.PhysicalUnitsXDirection = region.PhysicalUnitsYDirection = 3  # cm
            region.PhysicalDeltaX, region.PhysicalDeltaY = .09, -.07
        self.save("dcm_ultrasound", bare)
        self.case("dcm_ultrasound", array, says=["no PixelSpacing (PhysicalDeltaX and PhysicalDeltaY"])
        regions[1].PhysicalUnitsXDirection = 4  # seconds: a curve of Doppler
        regions[1].PhysicalDeltaX = .08
        self.save("dcm_ultrasound_curve", bare)
        self.case("dcm_ultrasound_curve", array, says=["no PixelSpacing (PhysicalDeltaX and PhysicalDeltaY"])
        regions[1].PhysicalUnitsXDirection = 3  # two transducers
        self.save("dcm_ultrasounds", bare)
        self.case("dcm_ultrasounds", array, says=["PixelAspectRatio"], spacing=(1, 1.5, 2.5), unit="")
        flat = self.stack(array)
        for data in flat:
            del data.ImageOrientationPatient
        self.save("dcm_noiop", flat)
        self.case("dcm_noiop", array, says=["no ImageOrientationPatient (axial"])

        # Without any place slices lie at their SliceLocation, else in the order of their numbers.
        for word, says, origin, distance in (
                ("SliceLocation", "slices lie at their SliceLocation", (0, 0, -5), 2),
                ("SpacingBetweenSlices", "in the order of InstanceNumber, 3 mm apart (SpacingBetweenSlices)", (0, 0, 0), 3),
                ("SliceThickness", "in the order of InstanceNumber, 2 mm apart (SliceThickness)", (0, 0, 0), 2)):
            slices = self.stack(array)
            for z, data in enumerate(slices):
                del data.ImagePositionPatient, data.SliceThickness
                data.InstanceNumber = 20 - z if word == "SliceLocation" else 3 + 2 * z
                setattr(data, word, 2. * z - 5 if word == "SliceLocation" else distance)
            self.save("dcm_by_" + word, slices[::-1])
            self.case("dcm_by_" + word, array, says=[says], origin=origin, spacing=(.9, .7, distance))
        self.save("dcm_gaps", slices[:3] + slices[5:])  # numbers 3, 5, 7, 13, 15 and so on
        self.case("dcm_gaps", array[[0, 1, 2, 5, 6, 7]], says=["InstanceNumber: 9 to 11 are missing"], origin=(0, 0, 0),
                  spacing=(.9, .7, 2))
        for data in slices:
            data.InstanceNumber = 1
        self.save("dcm_nowhere", slices)
        self.bad("dcm_nowhere", "ImagePositionPatient: found none", "SliceLocation or InstanceNumber")

        def moved(name, shifts, axis=2):
            slices = self.stack(array)
            for data, shift in zip(slices, shifts):
                data.ImagePositionPatient[axis] = str(float(data.ImagePositionPatient[axis]) + shift)
            self.save(name, slices)

        # The line nearest to z_k = -30 + 2.5 k + s_k: numpy's fit of degree 1 is another least-squares solution.
        shifts = np.array([-.02, .02] * 4)
        step, begin = np.polyfit(np.arange(8), -30 + 2.5 * np.arange(8) + shifts, 1)
        largest = np.abs(begin + step * np.arange(8) - (-30 + 2.5 * np.arange(8) + shifts)).max()
        moved("dcm_jitter", shifts)
        self.case("dcm_jitter", array, origin=(-10, -20, begin), spacing=(.9, .7, step),
                  says=["2.46 to 2.54 mm", f"up to {largest:.2g} mm"])
        moved("dcm_jitter_much", 6.5 * shifts)  # up to .16 mm off the line, 6.5 % of a distance
        self.bad("dcm_jitter_much", "ImagePositionPatient", "does not lie on a line")
        moved("dcm_tilt_little", .001 * 2.5 * np.arange(8), axis=1)  # .06 degrees
        self.case("dcm_tilt_little", array, says=["0.057 degrees from right angles"], origin=(-10, -20, -30))
        self.oracle.CASES[-1]["near"] = .03  # half of what the axes turn by, over 17.5 mm and the slice
        moved("dcm_tilt", .01 * 2.5 * np.arange(8), axis=1)
        self.bad("dcm_tilt", "tilted gantry")
        double = self.stack(array)
        self.save("dcm_copies", double + [copy.deepcopy(double[3])])
        self.case("dcm_copies", array, says=["1 of 9 files are copies"])
        double[3].SOPInstanceUID = generate_uid()
        self.save("dcm_same", self.stack(array) + [double[3]])
        self.case("dcm_same", array, says=["1 slices too many"])
        for word, syntax in (("explicit", ExplicitVRLittleEndian), ("implicit", ImplicitVRLittleEndian)):
            name = f"dcm_bare_{word}"  # without the preamble and group 2
            self.save(name, self.stack(array, syntax=syntax))
            for file in os.listdir(f"{self.oracle.FOLDER}/{name}"):
                data = dcmread(f"{self.oracle.FOLDER}/{name}/{file}")
                del data.preamble, data.file_meta
                data.save_as(f"{self.oracle.FOLDER}/{name}/{file}", write_like_original=True)
            self.case(name, array)
        self.save("dcm_nested/sub", self.stack(array))
        self.case("dcm_nested", array)
        self.save("dcm_disc/DICOM/S1", self.stack(array))
        with open(f"{self.oracle.FOLDER}/dcm_disc/DICOMDIR", "wb") as out:
            out.write(bytes(128) + b"DICM" + b"\2\0\2\0UI\x14\0" + b"1.2.840.10008.1.3.10")
        self.case("dcm_disc", array)
        self.bad("dcm_dir", "found a DICOMDIR", "expected the folder", path="dcm_disc/DICOMDIR")

    def value_cases(self):
        array = self.whole() % 1000
        table = 5 * np.arange(900, dtype="<u2") + 3  # of -20 .. 879; samples above have the last value
        slices = self.stack(array.astype("<i2"))
        item = Dataset()
        item.add_new(0x00283002, "SS", [900, -20, 16])
        item.ModalityLUTType = "US"
        item.add_new(0x00283006, "OW", table.tobytes())
        for data in slices:
            data.ModalityLUTSequence = Sequence([item])
        self.save("dcm_lut", slices)
        self.case("dcm_lut", table[np.clip(array + 20, 0, 899)])
        item[0x00283006].value = table[:899].tobytes()
        self.save("dcm_lut_short", slices)
        self.bad("dcm_lut_short", "ModalityLUTSequence", "found 899", "expected 900")
        array[2] = np.maximum(array[2], 1)
        array[2, 4, 5:8] = 0
        padded = self.stack(array - 500)
        padded[2].add_new(0x00280120, "SS", -500)
        self.save("dcm_padding", padded)
        self.case("dcm_padding", array - 500, says=["PixelPaddingValue: found it 3 times"])
        padded[2].add_new(0x00280121, "SS", -101)
        self.save("dcm_padding_range", padded)
        self.case("dcm_padding_range", array - 500, says=[f"found it {int((array[2] < 400).sum())} times"])
        order = [2, 0, 1, 3, 4, 5, 6, 7]
        placed = self.frames(array[order])
        placed.FrameIncrementPointer = 0x00182005
        placed.SliceLocationVector = [30 + 2.5 * z for z in order]
        self.save("dcm_locations", [placed])
        self.case("dcm_locations", array, origin=(*ORIGIN[:2], ORIGIN[2] - 5))
        placed.SliceLocationVector.append(99)
        self.save("dcm_locations_surplus", [placed])
        self.case("dcm_locations_surplus", array[order], says=["SliceLocationVector with 8 places (9 are not used)"])
        placed.SliceLocationVector.pop()
        placed.SliceLocationVector[3] += 2
        self.save("dcm_locations_uneven", [placed])
        self.bad("dcm_locations_uneven", "SliceLocationVector: found", "not equally spaced")
        real = self.whole(dtype="<f4")
        data = self.frames(np.zeros(real.shape, "<u2"))
        data.BitsAllocated = 32
        del data.PixelData, data.BitsStored, data.HighBit, data.PixelRepresentation
        data.FloatPixelData = real.tobytes()
        self.save("dcm_float", [data])
        self.case("dcm_float", real, says=["no SpacingBetweenSlices (SliceThickness is taken)"])
        mapped = self.stack(array)
        item = Dataset()
        item.RealWorldValueSlope, item.RealWorldValueIntercept = .25, -3.
        for data in mapped:
            data.RealWorldValueMappingSequence = Sequence([item])
        self.save("dcm_mapped", mapped)
        self.case("dcm_mapped", array * .25 - 3, says=["RealWorldValueSlope is taken"])

    def kind_cases(self):
        array = self.whole()
        for word in ("LOCALIZER", "AXIAL"):
            scout = self.stack(self.whole((1, 6, 5)), ([0, 1, 0], [0, 0, -1]))[0]
            scout.ImageType = ["ORIGINAL", "PRIMARY", word]
            self.save("dcm_scout_" + word, self.stack(array) + [scout])
            self.case("dcm_scout_" + word, array, says=["set aside 1 of 9 slices, localizers"])
        # A file of many frames is larger than three files of one.
        self.save("dcm_frames_beside", [self.enhanced(array, [(-10, -20, -30 + 2.5 * i) for i in range(8)])])
        self.save("dcm_frames_beside", self.oracle.stack(self.whole((3, 4, 5)), "1.2.2", *AXIAL, SPACING, ORIGIN))
        self.case("dcm_frames_beside", array, says=['"series 1" (8 images), is drawn'])
        self.save("dcm_crossed", self.stack(array) + self.stack(array, ([0, 1, 0], [0, 0, -1])))
        self.bad("dcm_crossed", "ImageOrientationPatient", "another")
        label = self.frames(array[:, :8] % 2)
        label.SOPClassUID, label.Modality, label.BitsAllocated = "1.2.840.10008.5.1.4.1.1.66.4", "SEG", 1
        self.save("dcm_seg", [label])
        self.bad("dcm_seg", "SOPClassUID", "segmentation (DICOM SEG)", "segimage2itkimage")
        colour = self.stack(array)[0]
        colour.SamplesPerPixel, colour.PhotometricInterpretation = 3, "RGB"
        self.save("dcm_colour", [colour])
        self.bad("dcm_colour", "SamplesPerPixel: found 3 (RGB)", "colour")
        self.save("dcm_beside", self.stack(array) + [label, colour])
        self.case("dcm_beside", array, says=["2 of 10 files are set aside"])
        colour.SamplesPerPixel, colour.PhotometricInterpretation = 1, "PALETTE COLOR"
        self.save("dcm_palette", [colour])
        self.bad("dcm_palette", "PALETTE COLOR", "colour")
        for word, value in (("PhotometricInterpretation", "MONOCHROME1"), ("PresentationLUTShape", "INVERSE")):
            inverse = self.stack(array)
            for data in inverse:
                setattr(data, word, value)
            self.save("dcm_" + value, inverse)
            self.case("dcm_" + value, array, says=[f"its lowest value is white ({word} {value})"])
        structures = self.stack(array)[0]
        structures.SOPClassUID = "1.2.840.10008.5.1.4.1.1.481.3"
        del structures.PixelData, structures.Rows, structures.Columns
        self.save("dcm_structures", [structures])
        self.bad("dcm_structures", "found no pixels", "1.2.840.10008.5.1.4.1.1.481.3")
        structures.SOPClassUID = "1.2.840.10008.5.1.4.1.1.66.1"  # spatial registration
        self.save("dcm_registration", [structures])
        self.bad("dcm_registration", "found no pixels", "1.2.840.10008.5.1.4.1.1.66.1")

        def nuclear(name, spacing, **more):
            data = self.frames(array)
            detector = Dataset()
            detector.ImagePositionPatient = data.ImagePositionPatient
            detector.ImageOrientationPatient = data.ImageOrientationPatient
            del data.ImagePositionPatient, data.ImageOrientationPatient
            data.DetectorInformationSequence = Sequence([detector])
            data.Modality, data.SpacingBetweenSlices = "NM", spacing
            for word, value in more.items():
                setattr(data, word, value)
            self.save(name, [data])

        nuclear("dcm_nm", 2.5)
        self.case("dcm_nm", array)
        # Slices lie in front of the first one: PS3.3, C.8.4.15.
        nuclear("dcm_nm_front", -2.5)
        self.case("dcm_nm_front", array[::-1], origin=(-10, -20, -47.5))
        nuclear("dcm_nm_gated", 2.5, FrameIncrementPointer=[0x00540070, 0x00540080], SliceVector=[1, 2, 3, 4] * 2, TimeSlotVector=[1] * 4 + [2] * 4)
        self.case("dcm_nm_gated", array[4:], says=["TimeSlotVector"], time=1)
        nuclear("dcm_nm_views", 2.5, FrameIncrementPointer=[0x00540010, 0x00540090])
        self.bad("dcm_nm_views", "FrameIncrementPointer", "views of a gamma camera", "SliceVector")
        cine = self.frames(array)
        cine.FrameIncrementPointer, cine.FrameTime = 0x00181063, "33.3"
        self.save("dcm_cine", [cine])
        self.case("dcm_cine", array[5:6], says=["the 8 images at each place are times"], time=5)

    def mosaic_cases(self):
        slices = self.whole((7, 10, 12))
        tiles = np.zeros((30, 36), "<i2")
        for i, image in enumerate(slices):
            row, column = divmod(i, 3)
            tiles[row * 10:row * 10 + 10, column * 12:column * 12 + 12] = image

        def csa(second, tags):
            out = b"SV10\4\3\2\1" if second else b""
            out += struct.pack("<II", len(tags), 77)
            for name, items in tags:
                out += struct.pack("<64si4s3i", name.encode(), len(items), b"IS", 6, 6 if items else 0, 77)
                for i in range(6 if items else 0):
                    text = items[i].encode() + b"\0" if i < len(items) else b""
                    # The first form adds the number of items of the first tag to the length.
                    length = len(text) + (0 if second else 6)
                    out += struct.pack("<4i", length, len(text), 77, length) + text + bytes(-len(text) % 4)
            return out

        def mosaic(name, header, **more):
            data = self.stack(tiles[None])[0]
            data.ImageType = ["ORIGINAL", "PRIMARY", "M", "ND", "MOSAIC"]
            data.SpacingBetweenSlices = 2.5
            for word, value in more.items():
                setattr(data, word, value)
            # nibabel: ImagePositionPatient is that of an image as large as the mosaic around the first slice.
            data.ImagePositionPatient = [-10 - .9 * (36 - 12) / 2, -20 - .7 * (30 - 10) / 2, -30]
            if header is not None:
                data.add_new(0x00290010, "LO", "SIEMENS CSA HEADER")
                data.add_new(0x00291010, "OB", header + bytes(len(header) % 2))
            self.save(name, [data])

        for second in (True, False):
            for sign in (1, -1):
                name = f"dcm_mosaic_{1 + second}_{'up' if sign > 0 else 'down'}"
                mosaic(name, csa(second, [("First", ["1"]), ("NumberOfImagesInMosaic", ["7"]),
                                          ("SliceNormalVector", ["0", "0.0", f"{sign}.00000000"]), ("Empty", [])]))
                self.case(name, slices[::sign], origin=(-10, -20, -30 if sign > 0 else -45))
        # Two mosaics are two times.
        header = csa(True, [("NumberOfImagesInMosaic", ["7"]), ("SliceNormalVector", ["0", "0", "1"])])
        for number in (2, 1):
            mosaic("dcm_mosaic_times", header, AcquisitionNumber=number)
        self.case("dcm_mosaic_times", slices, says=["the 2 images at each place", "AcquisitionNumber"], time=1)
        mosaic("dcm_mosaic_none", None)
        self.bad("dcm_mosaic_none", "ImageType: found MOSAIC", "CSA header (0029,1010)")
        mosaic("dcm_mosaic_cut", csa(True, [("NumberOfImagesInMosaic", ["7"])])[:90])
        self.bad("dcm_mosaic_cut", "CSA header (0029,1010)", "truncated")


def kinds_of_dicom(oracle):
    kinds = Kinds(oracle)
    kinds.dose_cases()
    kinds.enhanced_cases()
    kinds.phase_cases()
    kinds.place_cases()
    kinds.value_cases()
    kinds.kind_cases()
    kinds.mosaic_cases()
