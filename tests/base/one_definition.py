#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Looks through the modules for what C++ takes in silence: two definitions of one name, and functions of one name in two
modules of which a call may take the other.

    one_definition.py --source DIR liblamina_base.a liblamina_image.a ...

It reads symbols with nm, and headers, because a function that every caller inlines leaves no symbol. Sizes are compared
for data alone: the code of one inline function differs from file to file with what the compiler inlined into it. Types
that are defined twice are found by names_test.cpp.
Exit code 1 and a line for each finding; 77 where nm or c++filt is missing.
"""
import argparse
import itertools
import pathlib
import re
import shutil
import subprocess
import sys
from typing import NamedTuple

ARITHMETIC = {
    "bool", "char", "signed char", "unsigned char", "short", "unsigned short", "int", "unsigned", "unsigned int",
    "long", "unsigned long", "long long", "unsigned long long", "float", "double", "long double", "wchar_t", "char8_t",
    "char16_t", "char32_t", "std::size_t", "std::ptrdiff_t", "std::int8_t", "std::int16_t", "std::int32_t",
    "std::int64_t", "std::uint8_t", "std::uint16_t", "std::uint32_t", "std::uint64_t"}


class Symbol(NamedTuple):
    module: str
    size: int
    kind: str  # as nm has it: T, W, V, ...
    name: str  # mangled


class Function(NamedTuple):
    place: str  # a module, or a header
    module: str
    name: str  # qualified
    parameters: tuple
    symbol: str  # mangled, "" in headers


def type_of(parameter):
    """A type without what does not choose between overloads."""
    parameter = re.sub(r"\bconst\b|&", " ", parameter)
    return re.sub(r" ?([<>*,]) ?", r"\1", " ".join(parameter.split()))


def parts_of(text):
    """Splits a list of parameters at its commas."""
    parts, depth = [""], 0
    for letter in text:
        depth += (letter in "<([{") - (letter in ">)]}")
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return parts if text.strip() not in ("", "void") else []


def overlap(first, second):
    """Whether a call meant for one may take the other: where they differ, numbers convert to numbers."""
    return len(first) == len(second) and all(
        a == b or (a in ARITHMETIC and b in ARITHMETIC) for a, b in zip(first, second))


def free_function(symbol, demangled):
    """None for members (types begin with a capital letter, namespaces do not), templates and what is no function."""
    found = re.fullmatch(r"((?:lamina::)(?:[a-z]\w*::|N_\w+::)*[a-z]\w*)(?:\[abi:\w+\])?\((.*)\)", demangled)
    if not found:
        return None
    return Function(f"lamina_{symbol.module}", symbol.module, found[1],
                    tuple(type_of(part) for part in parts_of(found[2])), symbol.name)


def functions_in_header(path, module, text):
    """Free functions that a header defines: such definitions begin a line in this code."""
    text = re.sub(r"//.*", "", text)
    namespace, found = "", []
    function = r"(?:inline|constexpr|LAMINA_INLINE)\b[^\n;{}()=]*?\b([a-z_]\w*)\(([^;{]*?)\)\s*(?:noexcept\s*)?\{"
    text = text.replace("LAMINA_SIMD_BEGIN", "namespace lamina::one_instruction_set {")
    for match in re.finditer(rf"^(?:namespace ([\w:]+) \{{|{function})", text, re.MULTILINE):
        if match[1]:
            namespace = match[1] if match[1].startswith("lamina") else f"{namespace}::{match[1]}"
        else:
            parts = [part.split("=")[0].strip() for part in parts_of(match[3])]
            parameters = tuple(type_of(re.sub(r"(?<=[\w&*> ])\b\w+$", "", part)) for part in parts)
            found.append(Function(path, module, f"{namespace}::{match[2]}", parameters, ""))
    return found


def same_names(functions):
    by_name = {}
    for function in functions:
        by_name.setdefault(function.name, []).append(function)
    return by_name.items()


def twice_defined(symbols, names):
    """Findings of one name with several definitions. `names`: demangled."""
    findings = []
    by_name = {}
    for symbol in symbols:
        by_name.setdefault(symbol.name, []).append(symbol)
    for name, several in by_name.items():
        strong = [symbol for symbol in several if symbol.kind in "TDBR"]
        modules = ", ".join(sorted({symbol.module for symbol in several}))
        data = {symbol.size for symbol in several if symbol.kind in "VuDBR"}
        if len(strong) > 1 or (strong and len(several) > 1):
            findings.append(f"{names[name]} is defined more than once: {modules}")
        elif len(data) > 1:
            findings.append(f"{names[name]} has several sizes: {modules}")
    return findings


def overlapping(functions):
    findings = []
    for name, several in same_names(functions):
        for a, b in itertools.combinations(sorted(set(several)), 2):
            if a.module != b.module and a.symbol != b.symbol and overlap(a.parameters, b.parameters):
                findings.append(f"{name}({', '.join(a.parameters)}) in {a.place} and "
                                f"{name}({', '.join(b.parameters)}) in {b.place}: a call may take the other")
    return findings


def headers_that_repeat(functions):
    findings = []
    for name, several in same_names(functions):
        for a, b in itertools.combinations(several, 2):
            if a.place != b.place and overlap(a.parameters, b.parameters):
                findings.append(f"{name} is defined in {a.place} and in {b.place}")
    return findings


def demangled(names):
    names = sorted(names)
    answer = subprocess.run(["c++filt"], input="\n".join(names), capture_output=True, text=True, check=True)
    return dict(zip(names, answer.stdout.splitlines()))


def symbols_of(nm, archive):
    module = pathlib.Path(archive).stem.removeprefix("liblamina_")
    answer = subprocess.run([nm, "--defined-only", "-P", archive], capture_output=True, text=True, check=True)
    found = []
    for line in answer.stdout.splitlines():
        fields = line.split()  # name, kind, value, size
        if len(fields) >= 3 and re.match(r"_Z\w*?6lamina", fields[0]) and fields[1] in "TDBRWVu":
            found.append(Symbol(module, int(fields[3], 16) if len(fields) > 3 else 0, fields[1], fields[0]))
    return found


def findings_in(symbols, headers):
    names = demangled({symbol.name for symbol in symbols})
    functions = [free_function(symbol, names[symbol.name]) for symbol in symbols]
    return (twice_defined(symbols, names) + overlapping([each for each in functions if each])
            + headers_that_repeat(headers))


def check_itself():
    """Mistakes planted here must be found, and what is allowed must not."""
    def found(symbols, *texts):
        headers = [each for number, text in enumerate(texts)
                   for each in functions_in_header(f"{number}.h", str(number), "namespace lamina {\n" + text)]
        return len(findings_in([Symbol(*symbol) for symbol in symbols], headers))

    sum_int, sum_double = "_ZN6lamina3sumEi", "_ZN6lamina3sumERKd"
    assert found([("a", 8, "T", sum_int), ("b", 8, "T", sum_int)]) == 1
    assert found([("a", 8, "T", sum_int), ("b", 8, "W", sum_int)]) == 1
    assert found([("a", 8, "W", sum_int), ("b", 9, "W", sum_int)]) == 0
    assert found([("a", 8, "V", "_ZTVN6lamina5ShapeE"), ("b", 16, "V", "_ZTVN6lamina5ShapeE")]) == 1
    assert found([("a", 8, "T", sum_int), ("b", 8, "T", sum_double)]) == 1
    assert found([("a", 8, "T", sum_int), ("a", 8, "T", sum_double)]) == 0  # one module sees both
    assert found([("a", 8, "T", sum_int), ("b", 8, "T", "_ZN6lamina3sumEid")]) == 0
    assert found([("a", 8, "T", sum_int), ("b", 8, "T", "_ZN6lamina5study3sumEi")]) == 0
    assert found([("a", 8, "T", "_ZN6lamina3sumENS_5ShapeE"), ("b", 8, "T", "_ZN6lamina3sumERKNS_5ShapeE")]) == 1
    assert found([("a", 8, "T", "_ZN6lamina3sumENS_5ShapeE"), ("b", 8, "T", "_ZN6lamina3sumENS_4TreeE")]) == 0
    assert found([("a", 8, "T", "_ZN6lamina5Shape3sumEi"), ("b", 8, "T", "_ZN6lamina5Shape3sumEd")]) == 0  # members
    sum_inline = "inline double sum(const std::vector<int>& of, int first) {\n"
    assert found([], sum_inline, sum_inline) == 1
    assert found([], sum_inline, "constexpr int sum(std::vector<int> of,\n   std::size_t n = 2) {\n") == 1
    assert found([], sum_inline, "inline double sum(const Shape& of, int first) {\n") == 0
    assert found([], sum_inline, "}\nnamespace lamina::study {\n" + sum_inline) == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--nm", default="nm")
    parser.add_argument("--source", type=pathlib.Path, required=True)
    parser.add_argument("archives", nargs="+")
    options = parser.parse_args()
    if not shutil.which(options.nm) or not shutil.which("c++filt"):
        print("skipped: nm or c++filt is missing")
        return 77
    check_itself()
    missing = [archive for archive in options.archives if not pathlib.Path(archive).exists()]
    if missing:
        print(f"not built, build all modules first: {', '.join(missing)}")
        return 1
    symbols = [symbol for archive in options.archives for symbol in symbols_of(options.nm, archive)]
    headers = []
    for folder in ("include", "src", "tools/lamina", "tools/lamina-mpi"):
        for path in sorted((options.source / folder).glob("*/**/*.h")):
            module = path.relative_to(options.source / folder).parts[0]
            headers += functions_in_header(str(path.relative_to(options.source)), module, path.read_text())
    if len(symbols) < 1000 or len(headers) < 250:  # an empty answer would hide everything
        print(f"found {len(symbols)} symbols of lamina and {len(headers)} definitions in headers, expected more")
        return 1
    findings = findings_in(symbols, headers)
    print("\n".join(findings) or f"{len(symbols)} symbols, {len(headers)} definitions in headers: none twice")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
