#!/usr/bin/env python3
"""Runs the examples of the documents: every fenced block of README.md and docs/ is tried as it stands there.

    tools/run_examples.py PROGRAM SEQUENCE --compiler C++ [--generated FOLDER] [--only PAGE]   all but Python
    tools/run_examples.py PROGRAM SEQUENCE --python FOLDER                                     Python's

SEQUENCE is a rendered world as EuRoC's folders are, which stands in for the data that the examples name; FOLDER has
the package for Python. The commands of a page run one after the other in a folder of their own. So that they end
soon, each run takes a dozen frames, experiments are listed, and worlds of the program are not rendered (`shortened`,
`synthesize`). A command that needs what a test does not have (NOT_HERE) must get as far as to miss just that; one of
another program (OTHER_PROGRAMS) is checked for the files, targets and options that it names. Options and Python names within sentences must exist, too.
Exit status: 0 all is well, 1 not (one a line, page:line).
"""
import argparse
import fnmatch
import json
import os
import pathlib
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import zlib

ROOT = pathlib.Path(__file__).resolve().parent.parent
FRAMES = 12  # of a run
SENDER = "sys.stdout.buffer"  # a block of Python with it is the program `sender` of other examples
# Inputs that a test does not have.
NOT_HERE = ["camera:*", "rtsp://*", "gst:*", "*.bag", "drive.mcap", "rosbag2_*"]
# What is not run, and why.
OTHER_PROGRAMS = {
    "./demo": "root, network; ./test and the installation on a bare system run it",
    "./test": "is what runs this",
    "tools/*": "root, network, or hours",
    "cmake": "built already",
    "ninja": "built already",
    "build/release/bench/*": "minutes",
    "docker": "network, root; tools/test_dockerfile.sh goes the same steps",
    "/usr/bin/python3": "network; ./test --full long installs the package",
    ".": "the same",
    "pip": "the same",
    "export": "ROS",
    "roslaunch": "ROS; tests/ros run the node",
    "build/release/plumbline-ros2": "DDS; tests/ros2 run the node",
}
# Names that stand for the reader's own, and what they are here.
SEQUENCES = ["PATH", "SEQUENCE", "REFERENCE", "V1_01", "V1_02", "data/MH_01_easy", "data/V1_01_easy",
             "data/second_day"]
RUNS = ["out", "out/V1_01", "out/localized", "out/a", "out/b", "out/c", "out/mh01", "out/walk", "a", "b", "R"]
PLAYED = 1016  # frames of a sequence: the rendered ones forth and back, as links


def run(command, folder, **arguments):
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=120, **arguments)


def blocks(page):
    """(number of the first line, language, lines) of each fenced block."""
    found = None
    for number, line in enumerate(page.read_text().splitlines(), 1):
        fence = re.match(r"\s*```(\w*)", line)
        if not fence:
            if found:
                found[2].append(line)
        elif found:
            yield found
            found = None
        else:
            found = (number + 1, fence[1], [])


def commands(first, lines):
    """(line, command) of a block for a shell; one that goes on in the next line is one."""
    begin, text = None, ""
    for number, line in enumerate(lines, first):
        line = re.split(r"\s+# ", line)[0].strip()
        begin = begin or number
        text = (text + " " + line).strip()
        if not text.endswith("|"):
            if text:
                yield begin, text
            begin, text = None, ""


# --- What stands in for the data of the examples

def rows_of(file):
    return [line.split(",") for line in file.read_text().splitlines() if not line.startswith("#")]


def play(rendered, folder, frames):
    """A sequence of so many frames: those that were rendered, forth and back."""
    cameras = rendered / "mav0"
    stamps = [int(row[0]) for row in rows_of(cameras / "cam0/data.csv")]
    step, there = stamps[1] - stamps[0], list(range(len(stamps)))
    order = there + there[-2:0:-1]
    played = [(stamps[0] + k * step, stamps[order[k % len(order)]]) for k in range(frames)]
    for camera in ("cam0", "cam1"):
        (folder / "mav0" / camera).mkdir(parents=True)
        (folder / "mav0" / camera / "data").symlink_to(cameras / camera / "data")
        shutil.copy(cameras / camera / "sensor.yaml", folder / "mav0" / camera)
        (folder / "mav0" / camera / "data.csv").write_text(
            "#timestamp,filename\n" + "".join(f"{time},{image}.png\n" for time, image in played))
    truth = {int(row[0]): row[1:] for row in rows_of(cameras / "state_groundtruth_estimate0/data.csv")}
    (folder / "mav0/state_groundtruth_estimate0").mkdir()
    (folder / "mav0/state_groundtruth_estimate0/data.csv").write_text(
        "#timestamp,pose\n" + "".join(",".join([str(time), *truth[image]]) + "\n" for time, image in played))
    for name in ("lines.csv", "surfaces.csv"):
        (folder / name).symlink_to(rendered / name)


def size_of(png):
    return struct.unpack(">II", png.read_bytes()[16:24])


def unpacked(png):
    """The grey levels of a PNG image of 8 bits."""
    data, parts, at = png.read_bytes(), b"", 8
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        parts += data[at + 8:at + 8 + length] if kind == b"IDAT" else b""
        at += length + 12
    width, height = size_of(png)
    raw, above, rows = zlib.decompress(parts), bytes(width), b""
    for y in range(height):
        method, row = raw[y * (width + 1)], bytearray(raw[y * (width + 1) + 1:(y + 1) * (width + 1)])
        for x in range(width):
            left, up, corner = row[x - 1] if x else 0, above[x], above[x - 1] if x else 0
            guess = left + up - corner
            nearest = min((left, up, corner), key=lambda value: abs(guess - value))
            row[x] = (row[x] + [0, left, up, (left + up) // 2, nearest][method]) & 255
        above = bytes(row)
        rows += above
    return rows


def write_video(path, images, rate_hz=10):
    """An AVI file of PNG images."""
    def chunk(kind, data):
        return kind + struct.pack("<I", len(data)) + data + bytes(len(data) % 2)

    width, height = size_of(images[0])
    most = max(image.stat().st_size for image in images)
    header = struct.pack("<14I", 10**6 // rate_hz, 0, 0, 0, len(images), 0, 1, most, width, height, 0, 0, 0, 0)
    stream = b"vidsMPNG" + struct.pack("<IHHIIIIIIII4H", 0, 0, 0, 0, 1, rate_hz, 0, len(images), most, 0, 0, 0, 0,
                                       width, height)
    form = struct.pack("<IiiHH4sIiiII", 40, width, height, 1, 24, b"MPNG", width * height * 3, 0, 0, 0, 0)
    streams = chunk(b"LIST", b"strl" + chunk(b"strh", stream) + chunk(b"strf", form))
    frames = b"".join(chunk(b"00dc", image.read_bytes()) for image in images)
    path.write_bytes(chunk(b"RIFF", b"AVI " + chunk(b"LIST", b"hdrl" + chunk(b"avih", header) + streams) +
                           chunk(b"LIST", b"movi" + frames)))


def numbers_of(sensor):
    text = sensor.read_text()
    return [float(number) for key in ("intrinsics", "distortion_coefficients", "data")
            for number in re.search(rf"\b{key}: \[([^\]]*)\]", text)[1].split(",")]


def write_cameras(rendered, folder, images):
    """Camera files of one camera and of the pair."""
    first = numbers_of(rendered / "mav0/cam0/sensor.yaml")
    one = (f"size: {list(size_of(images[0]))}\nintrinsics: {first[:4]}\ndistortion: radtan\n"
           f"distortion_coefficients: {first[4:8]}\nrate_hz: 10\n")
    for name in ("phone", "webcam", "door", "camera"):
        (folder / f"{name}.yaml").write_text(one)
    pair = one + "right:\n  " + one.replace("\n", "\n  ").replace("rate_hz: 10", "").rstrip() + \
        "\nright_from_left: [1, 0, 0, -0.11, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n"
    for name in ("pair", "zed", "robot"):
        (folder / f"{name}.yaml").write_text(pair)
    return one


def write_drive(folder, rendered, images):
    """A drive as KITTI's raw data have it."""
    drive = folder / "2011_09_26/2011_09_26_drive_0001_sync"
    width, height = size_of(images[0])
    fx, fy, cx, cy = numbers_of(rendered / "mav0/cam0/sensor.yaml")[:4]
    calibration = ""
    for camera, shift in ((0, 0), (1, -0.11 * fx)):
        (drive / f"image_0{camera}/data").mkdir(parents=True)
        for k, image in enumerate(images):
            (drive / f"image_0{camera}/data/{k:010}.png").symlink_to(
                str(image).replace("cam0", f"cam{camera}"))
        (drive / f"image_0{camera}/timestamps.txt").write_text(
            "".join(f"2011-09-26 13:02:{k / 10:012.9f}\n" for k in range(len(images))))
        calibration += (f"S_0{camera}: {width} {height}\nS_rect_0{camera}: {width} {height}\n"
                        f"P_rect_0{camera}: {fx} 0 {cx} {shift} 0 {fy} {cy} 0 0 0 1 0\n")
    (folder / "2011_09_26/calib_cam_to_cam.txt").write_text(calibration)


def write_rgbd(folder, images, camera):
    """The images of one camera as TUM's RGB-D data have them."""
    (folder / "rgb").symlink_to(images[0].parent)
    (folder / "rgb.txt").write_text("".join(f"{int(image.stem) / 1e9:.9f} rgb/{image.name}\n" for image in images))
    (folder / "camera.yaml").write_text(camera)


def write_sender(folder, block, images):
    """The program of the document, with the names that it leaves to the reader."""
    raw = folder / "raw"
    raw.mkdir()
    for image in images[:FRAMES]:
        for camera in ("cam0", "cam1"):
            (raw / f"{image.stem}.{camera}").write_bytes(
                unpacked(pathlib.Path(str(image).replace("cam0", camera))))
    width, height = size_of(images[0])
    text = "\n".join(block)
    # As the format has it: of a pair both images are in the header, and one behind the other.
    text = text.replace("left mono8 {width} {height}\\n", "left mono8 {width} {height}\\nright mono8 {width} {height}\\n")
    program = folder / "bin/sender"
    program.write_text(
        f"#!/usr/bin/python3\nimport pathlib\nwidth, height = {width}, {height}\nraw = pathlib.Path('{raw}')\n"
        "frames = [(int(left.stem), memoryview(left.read_bytes() + left.with_suffix('.cam1').read_bytes()))\n"
        f"          for left in sorted(raw.glob('*.cam0'))]\n{text}\n")
    program.chmod(0o755)


class Stage:
    """The data that examples name, a finished run, and the program under the names that they call it by."""

    def __init__(self, program, sequence, folder):
        self.program, self.folder = program, folder
        for name in ("long", "short", "bin", "data"):
            (folder / name).mkdir()
        play(sequence, folder / "long", PLAYED)
        play(sequence, folder / "short", FRAMES)
        self.images = sorted((sequence / "mav0/cam0/data").glob("*.png"))
        camera = write_cameras(sequence, folder, self.images)
        write_video(folder / "walk.mp4", self.images)
        write_drive(folder / "data", sequence, self.images)
        (folder / "data/rgbd_dataset_freiburg1_xyz").mkdir()
        write_rgbd(folder / "data/rgbd_dataset_freiburg1_xyz", self.images, camera)
        for k, name in enumerate(["run", "again"]):
            done = run([program, "run", folder / "short", "--from", str(k), "--out", folder / name, "--quiet"], folder)
            if done.returncode:
                sys.exit(f"run_examples.py: {done.stderr}")
        wrapper = folder / "bin/plumbline"
        wrapper.write_text(f"#!/bin/sh\nexec {sys.executable} -B {__file__} --as {program} {folder} \"$@\"\n")
        wrapper.chmod(0o755)
        for page in blocks_by_page():
            for _, language, lines in page[1]:
                if language == "python" and SENDER in "\n".join(lines):
                    write_sender(folder, lines, self.images)

    def page_folder(self, page, sequence="long"):
        """A new folder for the commands of a page."""
        folder = self.folder / "pages" / page.relative_to(ROOT).as_posix().replace("/", "_")
        (folder / "build/release").mkdir(parents=True)
        (folder / "build/release/plumbline").symlink_to(self.folder / "bin/plumbline")
        shutil.copytree(self.folder / "data", folder / "data", symlinks=True)
        for link in SEQUENCES:
            (folder / link).symlink_to(self.folder / sequence)
        for copy in RUNS:
            shutil.copytree(self.folder / ("again" if copy == "b" else "run"), folder / copy, dirs_exist_ok=True)
        for file in [*self.folder.glob("*.yaml"), self.folder / "walk.mp4"]:
            (folder / file.name).symlink_to(file)
        for file in ("groundtruth.txt", "refined.txt", "ESTIMATE"):
            shutil.copy(self.folder / "run/trajectory.txt", folder / file)
        (folder / "my.yaml").write_text("slam:\n  lag: 1\n")
        (folder / "examples").symlink_to(ROOT / "examples")
        recorded = pathlib.Path(os.environ.get("PLUMBLINE_DATA", ROOT.parent / "shared/data"))
        if recorded.is_dir():
            (folder / "DIR").symlink_to(recorded)
        else:
            (folder / "DIR").mkdir()
        return folder


# --- Commands, shortened

def value_of(arguments, option, default):
    return int(arguments[arguments.index(option) + 1]) if option in arguments else default


def shortened(arguments):
    """The arguments of the program for a test: fewer frames, any free port, experiments that are only listed."""
    command, result = arguments[0] if arguments else "", list(arguments)
    if command == "run":
        end = value_of(result, "--from", 0) + FRAMES * value_of(result, "--stride", 1)
        end = min(end, value_of(result, "--to", end))
        if "--to" in result:
            del result[result.index("--to"):result.index("--to") + 2]
        result += ["--to", str(end)]
    if command == "synth" and "--list" not in result:
        result += ["--set", "frames=2", "--set", "scale=0.1", "--set", "samples=1"]
    if command == "experiment":
        if not {"--list", "--dry-run"} & set(result):
            result.append("--dry-run")
        if not any(pathlib.Path("DIR").iterdir()):  # no recorded sequences here, of which these would be some
            result = [argument for k, argument in enumerate(result) if "--only" not in (argument, result[k - 1])]
    result = [argument.replace("10.0.0.7", "127.0.0.1:9") for argument in result]  # refuses at once
    if "--view" in result:
        at = result.index("--view") + 1
        result[at] = result[at].replace("8080", "0")
    return result


def stopped_when_shown(command):
    """Runs a command that shows something until it is stopped, and stops it then."""
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    waited_for = "stays at" if "--stay" in command else "http://"
    for line in process.stderr:
        sys.stderr.write(line)
        if waited_for in line:
            process.send_signal(signal.SIGINT)
            break
    sys.stderr.write(process.stderr.read())
    return 0 if process.wait() in (0, 130, -signal.SIGINT) else process.returncode


def synthesize(command, at, stage):
    """Renders a world of the user's; one of the program's, whose light takes many seconds, up to where it would write.
    The sequence in its place is then the one that was rendered before all."""
    out = pathlib.Path(command[at])
    if command[2].endswith(".yaml"):
        return subprocess.run(command).returncode
    done = subprocess.run([*command[:at], str(stage / "bin"), *command[at + 1:]], capture_output=True, text=True)
    if done.returncode != 2 or "bin: expected an empty folder" not in done.stderr:
        sys.stderr.write(done.stderr)
        return done.returncode or 1
    if out.is_symlink():
        out.unlink()
    out.symlink_to(stage / "long")
    return 0


def run_as_program(program, stage, arguments):
    """What the name of the program stands for in a page's folder."""
    command = [program, *shortened(arguments)]
    if arguments[:1] == ["synth"] and "--out" in arguments:
        return synthesize(command, command.index("--out") + 1, pathlib.Path(stage))
    if "--view" in command and ("--stay" in command or command[1] == "map"):
        return stopped_when_shown(command)
    return subprocess.run(command).returncode


def missing_input(text):
    words = text.replace("'", "").split()
    return next((word for word in words for name in NOT_HERE if fnmatch.fnmatch(word, name)), None)


def command_problem(text, folder, environment):
    """What is wrong with a command that is run, or None."""
    if text.startswith("git "):
        if not (ROOT / ".git").exists():  # an archive of the source
            return None
        folder = ROOT
    done = run(["bash", "-o", "pipefail", "-c", text], folder, env=environment)
    said = (done.stderr.strip().splitlines() or [""])[-1]
    missing = missing_input(text)
    if missing is None:
        return f"exit code {done.returncode}: {said}" if done.returncode else None
    if done.returncode == 2 and re.sub(".*@10.0.0.7", "", missing) in said:  # passwords are not told
        return None
    return f"expected to miss {missing}, found exit code {done.returncode}: {said}"


def other_problem(text):
    """What is wrong with a command of another program, of which it is checked what of ours it names."""
    built = "\n".join(file.read_text() for folder in ("", "apps", "cmake", "lab", "ros", "python", "tests")
                      for file in [*(ROOT / folder).glob("CMakeLists.txt"), *(ROOT / folder).glob("*/CMakeLists.txt"),
                                   *(ROOT / folder).glob("*.cmake")])
    words = text.split()
    named = re.findall(r"--target (\S+)", text) if words[0] == "cmake" else words[3:] if words[0] == "ninja" else []
    named += re.findall(r"-D(\w+)=", text)
    for name in named:
        if not re.search(rf"\b{name}\b", built):
            return f"{name} is neither built nor an option"
    presets = json.loads((ROOT / "CMakePresets.json").read_text())["configurePresets"]
    for preset in re.findall(r"--preset (\S+)", text) if words[0] == "cmake" else []:
        if preset not in {each["name"] for each in presets}:
            return f"there is no preset {preset}"
    if words[0] == "roslaunch":
        launch = next(ROOT.glob(f"ros/**/{words[2]}")).read_text()
        for name in re.findall(r"(\w+):=", text):
            if f'<arg name="{name}"' not in launch:
                return f"{words[2]} has no {name}"
    return None


# --- Pages

def blocks_by_page():
    for page in [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]:
        yield page, list(blocks(page))


def shell_problems(stage, page, found, used):
    environment = dict(os.environ, PATH=f"{stage.folder / 'bin'}:{os.environ['PATH']}", k="1")
    folder = None
    for first, language, lines in found:
        for number, text in commands(first, lines) if language == "sh" else []:
            other = next((name for name in OTHER_PROGRAMS if fnmatch.fnmatch(text.split()[0], name)), None)
            if other:
                used.add(other)
                problem = other_problem(text)
            else:
                folder = folder or stage.page_folder(page)
                problem = command_problem(text, folder, environment)
            if problem:
                yield f"{page.relative_to(ROOT)}:{number}: {text}: {problem}"


def camera_file_problem(stage, lines):
    """A camera file must be that of a pair of images of its size."""
    folder = stage.folder / "pair"
    for camera in ("cam0", "cam1"):
        (folder / "mav0" / camera / "data").mkdir(parents=True)
        (folder / "mav0" / camera / "data.csv").write_text("1,0.pgm\n")
        (folder / "mav0" / camera / "data/0.pgm").write_bytes(b"P5\n752 480\n255\n" + bytes(752 * 480))
    (folder / "camera.yaml").write_text("\n".join(lines))
    done = run([stage.program, "info", folder], folder)
    if done.returncode or "baseline      0.1100 m" not in done.stdout:
        return f"expected the camera file of a pair: {done.stdout}{done.stderr}"
    return None


def imu_file_problem(stage, lines):
    """A calibration of an inertial sensor must be taken with samples of its rate, and place it."""
    samples, calibration = stage.folder / "imu.csv", stage.folder / "imu.yaml"
    samples.write_text("".join(f"{5_000_000 * k},{k % 3 / 1000},0,0,0,0,9.81\n" for k in range(400)))
    calibration.write_text("\n".join(lines))
    done = run([stage.program, "info", samples, "--imu", calibration], stage.folder)
    if done.returncode or "from the left camera" not in done.stdout:
        return f"expected the calibration of an inertial sensor: {done.stdout}{done.stderr}"
    return None


def cpp_problem(stage, lines, compiler, generated):
    """A piece of C++ must be a value of a declaration of the laboratory."""
    source = stage.folder / "example.cc"
    text = "\n".join(lines)
    source.write_text('#include "lab/experiments/experiment.h"\nnamespace plumbline {\n'
                      f"const auto example = {text};\n}}\n")
    done = run([compiler, "-std=c++20", "-fsyntax-only", f"-I{ROOT}", f"-I{generated}", source], stage.folder)
    return done.stderr.strip().splitlines()[0] if done.returncode else None


def other_block_problems(stage, page, found, arguments):
    for first, language, lines in found:
        problem = None
        if language == "yaml":
            problem = (imu_file_problem if lines[0].startswith("imu:") else camera_file_problem)(stage, lines)
        elif language == "cpp":
            problem = cpp_problem(stage, lines, arguments.compiler, arguments.generated)
        elif language not in ("", "math", "python", "sh"):
            problem = f"nothing tries examples in {language}"
        if problem:
            yield f"{page.relative_to(ROOT)}:{first}: {problem}"


def sentences(page):
    """(line, code) of each piece of code within sentences."""
    fenced = False
    for number, line in enumerate(page.read_text().splitlines(), 1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
        elif not fenced:
            for code in re.findall(r"`([^`]+)`", line):
                yield number, code


def known_options(program):
    """Options of all commands and scripts, and the keys of configuration files."""
    names = re.findall(r"^  (\w+)  ", run([program, "help"], ROOT).stdout, re.MULTILINE)
    texts = [run([program, *name.split(), "--help"], ROOT).stdout
             for name in [*names, "map info", "map export", "map merge", "map view"]]
    for folder in ("tools", "examples", "ros", "lab", "cmake"):
        texts += [file.read_text(errors="replace") for file in (ROOT / folder).rglob("*")
                  if file.is_file() and file.suffix in ("", ".py", ".sh", ".cc", ".launch", ".txt", ".cmake")]
    texts += [(ROOT / name).read_text() for name in ("demo", "test")]
    flags = set(re.findall(r"(?<![\w-])--[a-z][a-z-]+", "\n".join(texts)))
    keys, groups = set(), []
    for line in run([program, "config", "--all"], ROOT).stdout.splitlines():
        entry = re.match(r"^( *)([\w.]+):", line)
        if entry:
            groups = [*groups[:len(entry[1]) // 2], entry[2]]
            keys.add(".".join(groups))
    return flags, keys


OF_OTHERS = {"--component", "--partition"}  # options of cmake and of sbatch


def option_problems(program, page, flags, keys):
    # Pages about what is gone name what is gone.
    if page.name in ("0033-what-was-removed.md", "0016-nothing-of-the-users-is-lost.md"):
        return
    for number, code in sentences(page):
        for flag in re.findall(r"(?<![\w-])--[a-z][a-z-]+", code):
            if flag not in flags | OF_OTHERS:
                yield f"{page.relative_to(ROOT)}:{number}: nothing has the option {flag}"
        key = re.fullmatch(r"([a-z_]+(?:\.[a-z0-9_]+)+)(?:\.\*|=.*)?", code)
        if key and key[1].split(".")[0] in keys and key[1] not in keys and "/" not in code:
            yield f"{page.relative_to(ROOT)}:{number}: there is no option {key[1]}"


# --- Python

PRELUDE = """
import numpy
def moving(frames=8):
    texture = numpy.kron(numpy.random.default_rng(1).integers(0, 256, (130, 200)), numpy.ones((4, 4)))
    texture = texture.astype(numpy.uint8)
    for k in range(frames):
        left, right = (numpy.ascontiguousarray(texture[:480, x:x + 640]) for x in (40 + 2 * k, 70 + 2 * k))
        yield 50_000_000 * k, left, right
source = moving()
launch = types.ModuleType("launch")          # ROS 2's is not among Debian's packages
launch.LaunchDescription, launch.actions = list, types.ModuleType("launch.actions")
launch.actions.ExecuteProcess = lambda cmd, output: cmd
sys.modules.update({"launch": launch, "launch.actions": launch.actions})
"""


CHECK_NAME = """
def named(owner, name, code):
    scope = getattr(plumbline, owner, None) if owner else plumbline
    if scope is not None and not hasattr(scope, name) and name not in getattr(scope, "__annotations__", {}):
        sys.exit(f"{code}: there is no such name")
"""


def python_problems(stage, page, found, package):
    """The blocks of a page are parts of one program; names in sentences are those of the package."""
    program = ""
    for first, language, lines in found:
        if language == "python" and SENDER not in "\n".join(lines):
            text = "\n" * (first - 1) + "\n".join(lines)
            program += f"exec(compile({text!r}, {str(page)!r}, 'exec'))\n"
            if "def generate_launch_description" in text:
                program += "generate_launch_description()\n"
    for number, code in sentences(page):
        name = re.match(r"(?:plumbline\.)?([A-Z]\w+)\.([a-z]\w*)(?=[\W]|$)", code) or \
            re.match(r"plumbline\.()(\w+)\(", code)
        if name:
            program += f"named({name[1]!r}, {name[2]!r}, 'line {number}, {name[0]}')\n"
    if not program:
        return
    done = run([sys.executable, "-B", "-c", "import sys, types, plumbline" + CHECK_NAME + PRELUDE + program],
               stage.page_folder(page, "short"), env=dict(os.environ, PYTHONPATH=str(package)))
    if done.returncode:
        yield f"{page.relative_to(ROOT)}: " + " | ".join(done.stderr.strip().splitlines()[-4:])


def problems(stage, arguments):
    used = set()
    flags, keys = known_options(arguments.program) if not arguments.python else (set(), set())
    for page, found in blocks_by_page():
        if arguments.only and not page.match(arguments.only):
            continue
        if arguments.python:
            yield from python_problems(stage, page, found, arguments.python.resolve())
            continue
        yield from option_problems(arguments.program, page, flags, keys)
        yield from shell_problems(stage, page, found, used)
        yield from other_block_problems(stage, page, found, arguments)
    if not arguments.only and not arguments.python:
        for name in sorted(OTHER_PROGRAMS.keys() - used):
            yield f"run_examples.py: no example calls {name} any more"


def main():
    if sys.argv[1:2] == ["--as"]:
        return run_as_program(sys.argv[2], sys.argv[3], sys.argv[4:])
    parser = argparse.ArgumentParser(description="Runs the examples of the documents.")
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("sequence", type=pathlib.Path)
    parser.add_argument("--compiler", default="c++")
    parser.add_argument("--generated", type=pathlib.Path, default=ROOT / "build/release/generated")
    parser.add_argument("--python", type=pathlib.Path)
    parser.add_argument("--only", help="one page, such as quickstart.md")
    arguments = parser.parse_args()
    arguments.program, arguments.sequence = arguments.program.resolve(), arguments.sequence.resolve()
    with tempfile.TemporaryDirectory() as folder:
        found = list(problems(Stage(arguments.program, arguments.sequence, pathlib.Path(folder)), arguments))
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
