# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""A master of ROS for the tests, a world in bags, and the node."""
import os
import pathlib
import signal
import socket
import subprocess
import time

import pytest

rospy = pytest.importorskip("rospy")
rosbag = pytest.importorskip("rosbag")
import numpy as np  # noqa: E402
from geometry_msgs.msg import PoseStamped, TransformStamped  # noqa: E402
from nav_msgs.msg import Odometry, Path  # noqa: E402
from sensor_msgs.msg import CameraInfo, Image, PointCloud2  # noqa: E402
from std_msgs.msg import String  # noqa: E402
from std_srvs.srv import Trigger  # noqa: E402
from tf2_msgs.msg import TFMessage  # noqa: E402
from visualization_msgs.msg import Marker  # noqa: E402

import plumbline  # noqa: E402

PACKAGE = pathlib.Path(os.environ["PLUMBLINE_ROS_PACKAGE"])


def wait_for(condition, seconds=90):
    """Whether it came true in time."""
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.05)
    return True


def free_port() -> int:
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


def stop(process: subprocess.Popen) -> int:
    """Ends what was started, gently at first, and returns its exit code."""
    if process.poll() is None:
        process.send_signal(signal.SIGINT)
    try:
        return process.wait(20)
    except subprocess.TimeoutExpired:
        process.kill()
        return process.wait()


def transform(parent: str, child: str, height: float, turn) -> TransformStamped:
    out = TransformStamped(child_frame_id=child)
    out.header.frame_id = parent
    out.transform.translation.z = height
    r = out.transform.rotation
    r.x, r.y, r.z, r.w = turn
    return out


@pytest.fixture(scope="session")
def ros(tmp_path_factory):
    port = free_port()
    os.environ |= {"ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_IP": "127.0.0.1",
                   "ROS_LOG_DIR": str(tmp_path_factory.mktemp("logs")),
                   "ROS_PACKAGE_PATH": str(PACKAGE)}
    master = subprocess.Popen(["roscore", "-p", str(port)], stdout=subprocess.DEVNULL)
    assert wait_for(lambda: "/rosout" in subprocess.run(
        ["rosnode", "list"], text=True, capture_output=True).stdout), "roscore does not start"
    rospy.init_node("test", disable_signals=True, disable_rostime=True)
    # The camera is in the base and looks ahead; the floor is 1 m below.
    mounted = rospy.Publisher("/tf_static", TFMessage, latch=True, queue_size=1)
    mounted.publish(TFMessage([transform("base_link", "camera", 0, (-0.5, 0.5, -0.5, 0.5)),
                               transform("floor", "base_link", 1, (0, 0, 0, 1))]))
    yield
    rospy.signal_shutdown("done")
    stop(master)


class World:
    """A rendered room, undistorted, frame by frame as messages. Depth in metres or millimetres."""

    def __init__(self, frames: int):
        self.synth = plumbline.Synth("room", frames=frames, rate_hz=10, scale=0.5, samples=1,
                                     distortion=False)
        self.frames = list(self.synth)
        self.first_ns = 1_000_000_000_000  # ROS has no times before 0

    def stamp(self, frame, late_ns=0):
        ns = frame.stamp_ns - self.frames[0].stamp_ns + self.first_ns + late_ns
        return rospy.Time(ns // 10**9, ns % 10**9)

    def image(self, frame, pixels: np.ndarray, encoding: str, late_ns=0) -> Image:
        message = Image(height=pixels.shape[0], width=pixels.shape[1], encoding=encoding,
                        step=pixels.strides[0], data=pixels.tobytes())
        message.header.stamp = self.stamp(frame, late_ns)
        message.header.frame_id = "camera"
        return message

    def info(self, frame, right: bool) -> CameraInfo:
        camera = self.synth.calibration
        K = camera.K
        P = np.hstack([K, [[-K[0, 0] * camera.baseline if right else 0], [0], [0]]])
        message = CameraInfo(height=camera.height, width=camera.width, K=K.ravel().tolist(),
                             D=[0.0] * 5, R=np.eye(3).ravel().tolist(), P=P.ravel().tolist(),
                             distortion_model="plumb_bob")
        message.header.stamp = self.stamp(frame)
        return message

    def write(self, path: pathlib.Path, late_ns=0, millimetres=False) -> pathlib.Path:
        """All of it in a bag; second images `late_ns` after the first."""
        with rosbag.Bag(str(path), "w") as bag:
            for frame in self.frames:
                depth = np.array(frame.depth)
                if millimetres:
                    depth = np.uint16(np.minimum(np.round(1000 * depth), 65535))
                for topic, message in (
                        ("/left/camera_info", self.info(frame, False)),
                        ("/right/camera_info", self.info(frame, True)),
                        ("/left/image", self.image(frame, frame.left, "mono8")),
                        ("/right/image", self.image(frame, frame.right, "mono8", late_ns)),
                        ("/depth/image", self.image(
                            frame, depth, "16UC1" if millimetres else "32FC1", late_ns))):
                    bag.write(topic, message, t=self.stamp(frame, late_ns))
        return path

    def errors(self, poses: list[PoseStamped]) -> dict:
        """Of the base, which is the camera turned, after alignment."""
        stamps = [pose.header.stamp.to_nsec() - self.first_ns + self.frames[0].stamp_ns
                  for pose in poses]
        estimate = plumbline.Trajectory(
            np.array(stamps), [[p.pose.position.x, p.pose.position.y, p.pose.position.z]
                               for p in poses], [[0, 0, 0, 1]] * len(poses))
        return plumbline.compare_trajectories(self.synth.ground_truth, estimate)


@pytest.fixture(scope="session")
def world():
    return World(30)


@pytest.fixture(scope="session")
def bag(world, tmp_path_factory):
    return world.write(tmp_path_factory.mktemp("bags") / "room.bag")


class Listener:
    """Keeps what the node publishes."""

    TOPICS = {"pose": PoseStamped, "odometry": Odometry, "state": String, "path": Path,
              "points": PointCloud2, "lines": Marker}

    def __init__(self, name: str):
        self.heard = {topic: [] for topic in self.TOPICS} | {"tf": []}
        self.subscribers = [
            rospy.Subscriber(f"/{name}/{topic}", kind, self.heard[topic].append, queue_size=1000)
            for topic, kind in self.TOPICS.items()]
        self.subscribers.append(rospy.Subscriber(
            "/tf", TFMessage, lambda message: self.heard["tf"].extend(message.transforms),
            queue_size=1000))

    def __getattr__(self, topic):
        return self.heard[topic]

    def forget(self):
        for messages in self.heard.values():
            messages.clear()

    def close(self):
        for subscriber in self.subscribers:
            subscriber.unregister()


class Node:
    """A running node with a name of its own, and what it says. `parameters` are private ones."""

    number = 0

    def __init__(self, *arguments: str, **parameters: object):
        Node.number += 1
        self.name = f"plumbline_{Node.number}"
        for name, value in parameters.items():
            rospy.set_param(f"/{self.name}/{name}", value)
        self.listener = Listener(self.name)
        self.process = subprocess.Popen(
            [str(PACKAGE / "plumbline_node"), f"__name:={self.name}", *arguments],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def call(self, service: str) -> Trigger:
        rospy.wait_for_service(f"/{self.name}/{service}", 30)
        return rospy.ServiceProxy(f"/{self.name}/{service}", Trigger)()

    def stop(self) -> tuple[int, str]:
        self.listener.close()
        code = stop(self.process)
        rospy.delete_param(f"/{self.name}") if rospy.has_param(f"/{self.name}") else None
        return code, self.process.stdout.read()


# Every frame counts, however slow the machine.
PATIENT = {"queue_size": 1000, "options": {"slam": {"mode": "lockstep"}}}


@pytest.fixture
def node(ros):
    """Makes nodes, and ends them."""
    made = []

    def make(*arguments: str, **parameters: object) -> Node:
        made.append(Node(*arguments, **(PATIENT | parameters)))
        rospy.wait_for_service(f"/{made[-1].name}/reset", 60)
        return made[-1]

    yield make
    for one in made:
        if one.process.poll() is None:
            code, said = one.stop()
            assert code == 0, said


def play(bag: pathlib.Path, *arguments: str) -> None:
    subprocess.run(["rosbag", "play", "--quiet", "--delay", "1", *arguments, str(bag)], check=True,
                   stdout=subprocess.DEVNULL)
