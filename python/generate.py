#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tables of structs, enumerations and documentation for the Python module, out of the public headers.

    generate.py OUT_DIR HEADER...   writes fields.h and documents.h

Names and comments come from here; types and defaults are the compiler's business. A struct of the headers needs nothing else
to become a class of the module, nor does an option of it to become a keyword."""
import keyword
import re
import sys
from typing import NamedTuple

# Structs and enumerations that Python sees.
NAMES = """PointSet TriangleMesh TexturedMesh CameraModel CameraProjection View CameraSet ScanInfo MeshTopology
NormalOptions NormalField BilateralOptions BilateralResult MixedPixelOptions OutlierOptions
ScanRegistrationOptions ScanRegistrationResult ScanResult PairResult AlternativePose FreeMotion
HintKind RegistrationHint RefusalReason Refusal CandidatePlace
VolumetricOptions VolumetricResult NormalFilteringOptions NormalFilteringResult NormalFilteringStep
DepthFusionOptions DepthFusionResult MeshDistanceOptions MeshDistanceResult TwoSidedDistance DistanceStatistics
NormalDeviation TextureOptions TextureView TextureResult PlacedCamera PhotographFit PointTextureOptions PointTextureResult
PointLook SimplificationOptions LightModelOptions GltfModel GltfOptions ModelOptions ModelReport ModelStage PictureOptions Viewpoint
PointToPlaneOptions PointToPlaneResult CameraAlignmentOptions CameraAlignmentResult RgbdTrackingOptions
RgbdTrackingResult PlanOptions PlanOpening PlanWall PlanRoom FloorPlan
ScaledPicture""".split()
# What a function is called in Python where it is not its name in C++ with underscores.
RENAMED = {"reconstructVolumetric": "reconstruct", "filterSurface": "optimize",
           "measureMeshDistance": "compare", "withoutMixedPixels": "remove_mixed_pixels", "withoutOutliers": "remove_outliers",
           "readColmap": "read_cameras", "writeColmap": "write_cameras"}
ERRORS = {"std::invalid_argument": "ValueError", "std::runtime_error": "Error"}


class Field(NamedTuple):
    name: str
    text: str


class Struct(NamedTuple):
    name: str
    base: str
    text: str
    fields: list[Field]


def python_name(name: str) -> str:
    return RENAMED.get(name) or re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).lower()


def in_python(text: str) -> str:
    """Words of C++ as Python has them: arrays are a row per point, names have underscores."""
    text = re.sub(r"\b([23])x([A-Z01])\b", r"(\2, \1)", text)
    text = re.sub(r"\b(?<!::)([a-z]+[A-Z]\w*)\(\)", lambda m: python_name(m[1]) + "()", text)
    text = re.sub(r"\b(\w+)::(\w+)\b", lambda m: ERRORS.get(m[0], f"{m[1]}.{m[2]}"), text)
    return text.replace("std.vector", "list")


def join(lines: list[str]) -> str:
    """Paragraphs of a comment; those that are indented keep their lines."""
    text = ""
    for line in lines:
        if not line.strip():
            text += "\n\n"
        elif line.startswith("  ") and not line.lstrip().startswith("@"):
            text += ("" if text.endswith("\n") else "\n") + line + "\n"
        else:
            text += ("" if not text or text.endswith("\n") else " ") + line.strip()
    return re.sub(r"\n{3,}", "\n\n", text).strip("\n")


def document(lines: list[str]) -> str:
    """Text of a function's comment with its @param, @return and @throws as sections."""
    parts: list[list[str]] = [[]]
    for line in lines:
        for piece in re.split(r"(?<=\.) (?=@)", line):
            if piece.lstrip().startswith("@"):
                parts.append([])
            parts[-1].append(piece.strip() if len(parts) > 1 else piece)
    sections: dict[str, list[str]] = {"Arguments": [], "Returns": [], "Raises": []}
    for tag, _, text in (" ".join(part).partition(" ") for part in parts[1:]):
        if tag == "@param":
            names, body = re.match(r"((?:\w+, )*\w+)\s+(.*)", text).groups()
            sections["Arguments"].append(f"{names}: {body}")
        elif tag == "@throws":
            sections["Raises"].append(in_python(text))
        else:
            sections["Returns"].append(text)
    text = join(parts[0])
    for title, entries in sections.items():
        if entries:
            text += f"\n\n{title}:\n" + "\n".join("    " + entry for entry in entries)
    return in_python(text.strip("\n"))


class Reader:
    """One header, line by line."""

    def __init__(self, text: str) -> None:
        self.lines = text.split("\n")
        self.structs: list[Struct] = []
        self.enums: dict[str, list[str]] = {}
        self.functions: dict[str, str] = {}
        self.comment: list[str] = []
        at = 0
        while at < len(self.lines):
            at = self.step(at)

    def step(self, at: int) -> int:
        line = self.lines[at]
        if found := re.match(r"\s*/// ?(?!<)(.*)", line):
            self.comment.append(found[1])
            return at + 1
        if (found := re.match(r"struct (?:FRESCO_EXPORT )?(\w+)(?: : (\w+))? \{", line)) and found[1] in NAMES:
            at = self.read_struct(at, found[1], found[2] or "")
        elif (found := re.match(r"enum class (\w+) \{(.*)", line)) and found[1] in NAMES:
            at = self.read_enum(at, found[1])
        elif found := re.match(r"(?:FRESCO_EXPORT )?[\w:<>,& ]+? \*?(\w+)\(", line) or re.match(r"(with\w+)\(", line):
            if self.comment and not line.startswith(" "):
                self.functions.setdefault(found[1], document(self.comment))
        elif line.startswith("FRESCO_EXPORT") and not line.rstrip().endswith(";"):
            return at + 1  # the name follows on the next line
        self.comment = []
        return at + 1

    def read_enum(self, at: int, name: str) -> int:
        text = ""
        while True:
            text += re.sub(r"///.*", "", self.lines[at])
            if "};" in self.lines[at]:
                break
            at += 1
        self.enums[name] = re.findall(r"\w+", text[text.index("{"):])
        return at

    def read_struct(self, at: int, name: str, base: str) -> int:
        struct = Struct(name, base, in_python(join(self.comment)), [])
        before: list[str] = []  # comment lines ahead of a field
        depth = 0
        at += 1
        while not self.lines[at].startswith("};"):
            line = self.lines[at]
            code = re.sub(r"\s*//.*", "", line)
            if depth == 0 and (found := re.match(r"  /// ?(?!<)(.*)", line)):
                before.append(found[1])
            elif depth == 0 and code.endswith(";") and not re.match(r"  (using|static|struct|enum|friend)\b", code):
                text = list(before)
                if found := re.search(r"///< ?(.*)", line):
                    text.append(found[1])
                while found := re.match(r"\s+///< ?(.*)", self.lines[at + 1]):
                    at += 1
                    text.append(found[1].strip())
                for field in self.names_of(code):
                    struct.fields.append(Field(field, in_python(join(text))))
                before = []
            elif depth == 0 and re.match(r"  [\w:<>, ]+=?$", code):  # a declaration that goes on in the next line
                self.lines[at + 1] = code + " " + self.lines[at + 1].strip()
            else:
                if depth == 0 and code.strip() and not re.search(r"[(){}]|^  (using|static|friend|explicit)\b", code):
                    sys.exit(f"generate.py: cannot read a field of {name}: {line}")
                depth += code.count("{") - code.count("}")
                before = []
            at += 1
        self.structs.append(struct)
        return at

    @staticmethod
    def names_of(code: str) -> list[str]:
        """Names that a declaration of fields declares; none for a method, nor for what only C++ can make."""
        if re.search(r"_ptr<|std::function<|\bSimilarity\b", code):
            return []
        code = re.sub(r"<[^;=]*>", "", code)
        code = re.sub(r"\{[^}]*\}", "", code)
        if re.match(r"[^=]*\(", code):
            return []
        return [re.findall(r"\w+", part.split("=")[0])[-1] for part in code.strip().rstrip(";").split(",")
                if re.search(r"\w", part.split("=")[0]) and not re.fullmatch(r"\s*[\d.()]+\s*", part)]


def literal(text: str) -> str:
    return f'R"doc({text})doc"'


def table(struct: Struct, structs: dict[str, Struct]) -> str:
    fields = (structs[struct.base].fields if struct.base else []) + struct.fields
    visits = "".join(f'    visit("{f.name}{"_" * keyword.iskeyword(f.name)}", &{struct.name}::{f.name}, {literal(f.text)});\n' for f in fields)
    return (f"template <>\nstruct Fields<{struct.name}> {{\n"
            f'  static constexpr const char* name = "{struct.name}";\n'
            f"  static constexpr const char* text = {literal(struct.text)};\n"
            f"  template <typename Visitor>\n  static void visit(Visitor&& visit)\n  {{\n{visits}  }}\n}};\n")


def main() -> None:
    folder, headers = sys.argv[1], sys.argv[2:]
    structs: dict[str, Struct] = {}
    enums: dict[str, list[str]] = {}
    functions: dict[str, str] = {}
    for path in headers:
        with open(path, encoding="utf8") as file:
            reader = Reader(file.read())
        structs.update((struct.name, struct) for struct in reader.structs)
        enums.update(reader.enums)
        for name, text in reader.functions.items():
            functions.setdefault(name, text)
    if missing := [name for name in NAMES if name not in structs and name not in enums]:
        sys.exit(f"generate.py: no header declares {', '.join(missing)}")
    includes = "".join(f"#include <{path.split('/include/')[1]}>\n" if "/include/" in path else
                       f"#include \"{path.split('/tools/')[1]}\"\n" for path in headers)
    with open(folder + "/fields.h", "w", encoding="utf8") as file:
        file.write("// Made by generate.py.\n#pragma once\n" + includes +
                   "namespace fresco::python {\nusing namespace fresco::rendering;\ntemplate <typename T>\nstruct Fields;\n"
                   "template <typename T>\nstruct Enumerators;\n")
        file.writelines(table(structs[name], structs) for name in NAMES if name in structs)
        for name, values in enums.items():
            pairs = ", ".join(f'{{{name}::{value}, "{value}"}}' for value in values)
            file.write(f"template <>\nstruct Enumerators<{name}> {{\n"
                       f"  static constexpr std::pair<{name}, const char*> all[] = {{{pairs}}};\n}};\n")
        file.write("} // namespace fresco::python\n")
    with open(folder + "/documents.h", "w", encoding="utf8") as file:
        file.write("// Made by generate.py.\n#pragma once\n#include <utility>\nnamespace fresco::python {\n"
                   "constexpr std::pair<const char*, const char*> documents[] = {\n")
        file.writelines(f'  {{"{name}", {literal(text)}}},\n' for name, text in sorted(functions.items()))
        file.write("};\n} // namespace fresco::python\n")


if __name__ == "__main__":
    main()
