#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""reader_oracles.py FOLDER TOOL: with NumPy, nibabel, tifffile or VTK, writes volumes to FOLDER in every form that these
know, and to FOLDER/cases.json what each holds, by the tool itself. Exits with 77 where the tool is not installed.

A case: {file, request, type, size [x, y, z], steps (three vectors), origin, cell, values}; `values` names a file of
float64, x fastest: the values that are drawn. Or {file, request, error}: words of the message that refuses the file.
"""
import importlib
import sys

sys.dont_write_bytecode = True


def main():
    folder, tool = sys.argv[1:]
    try:
        from oracles.cases import Cases
        cases = Cases(folder)
        getattr(importlib.import_module(f"oracles.{tool}_files"), f"{tool}_files")(cases)
    except ImportError as error:
        print(error, file=sys.stderr)
        sys.exit(77)
    cases.write()


main()
