#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""The hashes of ROS 2's types (RIHS01, REP 2011 and REP 2016) that plumbline-ros2 sends.

  tools/type_hashes.py                prints the table of ros/ros2_type_hashes.cc
  tools/type_hashes.py --check FILE   exit status 1 if a line of it is not in the file

A hash is the SHA-256 of the description of a type in JSON, with all types that it uses, sorted by
name. Types are read from tests/ros2/messages.idl; octet is uint8 there. It checks itself by hashes
that `ros2 topic info --verbose` shows.
"""
import hashlib
import json
import pathlib
import re
import sys

IDL = pathlib.Path(__file__).resolve().parent.parent / "tests/ros2/messages.idl"
# Of type_description_interfaces/msg/FieldType; an array has 48 more, a sequence 144 more.
NESTED, ARRAY, SEQUENCE, BOUNDED_TEXT = 1, 48, 144, 21
PRIMITIVES = {"octet": 3, "long": 6, "unsigned long": 7, "float": 10, "double": 11, "boolean": 15,
              "string": 17}
SENT = ("geometry_msgs/PoseStamped", "nav_msgs/Odometry", "nav_msgs/Path", "rosgraph_msgs/Clock",
        "rmw_dds_common/ParticipantEntitiesInfo", "sensor_msgs/CameraInfo", "sensor_msgs/CompressedImage",
        "sensor_msgs/Image", "sensor_msgs/Imu", "sensor_msgs/PointCloud2", "std_msgs/String",
        "tf2_msgs/TFMessage", "visualization_msgs/MarkerArray")
PUBLISHED = {
    "std_msgs/msg/String": "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18",
    "sensor_msgs/msg/Image": "d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47",
    "rosgraph_msgs/msg/Clock": "692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564",
}


def read_types(text: str) -> dict[str, list[tuple[str, str]]]:
    """Types by name, each with its fields: (type as written, name)."""
    types, module = {}, []
    text = re.sub(r"//.*", "", text)
    for token in re.finditer(r"module (\w+) \{|struct (\w+) \{([^}]*)\};|\};", text):
        if token[1]:
            module.append(token[1])
        elif token[2] and module:
            fields = [tuple(part.strip().rsplit(None, 1)) for part in token[3].split(";") if part.strip()]
            types[f"{module[0]}/msg/{token[2].rstrip('_')}"] = fields
        elif not token[2]:
            module.pop()
    return types


def field_type(written: str, name: str, package: str) -> dict:
    size = re.search(r"\[(\d+)\]$", name)
    inner = re.fullmatch(r"sequence<(.*)>", written)
    kind, capacity, bound, nested = 0, 0, 0, ""
    if inner:
        kind, written = SEQUENCE, inner[1]
    elif size:
        kind, capacity = ARRAY, int(size[1])
    text = re.fullmatch(r"string<(\d+)>", written)
    if text:
        kind, bound = kind + BOUNDED_TEXT, int(text[1])
    elif written in PRIMITIVES:
        kind += PRIMITIVES[written]
    else:
        kind, parts = kind + NESTED, written.split("::")
        nested = f"{parts[0] if len(parts) > 1 else package}/msg/{parts[-1].rstrip('_')}"
    return {"type_id": kind, "capacity": capacity, "string_capacity": bound, "nested_type_name": nested}


def describe(name: str, types: dict) -> dict:
    package = name.split("/")[0]
    fields = [{"name": re.sub(r"\[.*", "", field), "type": field_type(written, field, package)}
              for written, field in types[name]]
    return {"type_name": name, "fields": fields}


def used_by(name: str, types: dict) -> set[str]:
    used = {field["type"]["nested_type_name"] for field in describe(name, types)["fields"]} - {""}
    return used.union(*(used_by(other, types) for other in used))


def type_hash(name: str, types: dict) -> str:
    description = {"type_description": describe(name, types),
                   "referenced_type_descriptions": [describe(other, types)
                                                    for other in sorted(used_by(name, types))]}
    return hashlib.sha256(json.dumps(description).encode()).hexdigest()


def main(arguments: list[str]) -> int:
    types = read_types(IDL.read_text())
    for name, published in PUBLISHED.items():
        if type_hash(name, types) != published:
            sys.exit(f"{name}: expected the published hash {published}, found {type_hash(name, types)}")
    lines = []
    for name in SENT:
        package, message = name.split("/")
        lines.append(f'    {{"{name}",\n     "RIHS01_{type_hash(f"{package}/msg/{message}", types)}"}},')
    if arguments[:1] != ["--check"]:
        print("\n".join(lines))
        return 0
    text = "".join(pathlib.Path(arguments[1]).read_text().split())
    missing = [line for line in lines if "".join(line.split()) not in text]
    for line in missing:
        print(f"{arguments[1]}: expected\n{line}", file=sys.stderr)
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
