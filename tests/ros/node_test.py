# SPDX-FileCopyrightText: 2026 The Plumbline authors
# SPDX-License-Identifier: Apache-2.0
"""The node of ROS 1 with a real master, bags that are played, and subscribers."""
import os
import pathlib
import subprocess

import numpy as np
import pytest

if not os.environ.get("PLUMBLINE_LONG"):
    pytest.skip("PLUMBLINE_LONG is not set", allow_module_level=True)  # they take minutes
from master import (PACKAGE, Listener, Node, World, bag, node, play, ros, rospy,  # noqa: F401
                    stop, wait_for, world)

import plumbline

STEREO = ("left/image:=/left/image", "right/image:=/right/image")
ONE = ("image:=/left/image", "camera_info:=/left/camera_info")


def matrix(place, turn) -> np.ndarray:
    pose = plumbline.Trajectory([0], [[place.x, place.y, place.z]],
                                [[turn.x, turn.y, turn.z, turn.w]])
    return pose.poses[0]


def pose_matrix(pose) -> np.ndarray:
    return matrix(pose.position, pose.orientation)


def transforms(listener, child) -> dict:
    return {one.header.stamp.to_nsec(): matrix(one.transform.translation, one.transform.rotation)
            for one in listener.tf if one.child_frame_id == child}


def test_a_pair(node, world, bag):
    running = node(*STEREO, sensor="stereo", map_period=0.2)
    heard = running.listener
    play(bag)
    assert wait_for(lambda: len(heard.pose) == len(world.frames)), heard.state
    assert world.errors(heard.pose)["ate"]["rmse"] < 0.02
    stamps = [world.stamp(frame).to_nsec() for frame in world.frames]
    assert [pose.header.stamp.to_nsec() for pose in heard.pose] == stamps
    assert {pose.header.frame_id for pose in heard.pose} == {"map"}
    assert heard.state[-1].data == "tracked"
    # The frames of REP 105: map to odom to base_link is the pose in the map.
    assert wait_for(lambda: len(transforms(heard, "base_link")) == len(stamps))
    odom, base = transforms(heard, "odom"), transforms(heard, "base_link")
    for pose in heard.pose:
        stamp = pose.header.stamp.to_nsec()
        np.testing.assert_allclose(odom[stamp] @ base[stamp], pose_matrix(pose.pose), atol=1e-9)
    # The base starts where the map does, and looks along x: z is up (REP 103).
    np.testing.assert_allclose(pose_matrix(heard.pose[0].pose), np.eye(4), atol=1e-9)
    for message, stamp in zip(heard.odometry, stamps):
        assert (message.header.frame_id, message.child_frame_id) == ("odom", "base_link")
        np.testing.assert_allclose(pose_matrix(message.pose.pose), base[stamp], atol=1e-9)
    # How well each pose is known, but for that which starts the map.
    covariances = [np.reshape(m.pose.covariance, (6, 6)) for m in heard.odometry]
    assert not covariances[0].any()
    for covariance in covariances[1:]:
        np.testing.assert_array_equal(covariance, covariance.T)
        assert np.linalg.eigvalsh(covariance)[0] > 0
    speeds = [np.linalg.norm([m.twist.twist.linear.x, m.twist.twist.linear.y,
                              m.twist.twist.linear.z]) for m in heard.odometry[1:]]
    moved = np.linalg.norm(np.diff(world.synth.ground_truth.positions, axis=0), axis=1)
    np.testing.assert_allclose(speeds, 10 * moved, atol=0.1)
    # The map, latched, once it was asked for.
    assert wait_for(lambda: heard.points and heard.lines and heard.path)
    assert heard.points[-1].width * heard.points[-1].height > 300
    assert heard.points[-1].header.frame_id == heard.lines[-1].header.frame_id == "map"
    assert len(heard.lines[-1].points) > 20 and len(heard.lines[-1].points) % 2 == 0
    assert len(heard.path[-1].poses) >= 2


def test_one_camera_waits_for_its_map(node, bag):
    running = node(*ONE)
    play(bag)
    assert wait_for(lambda: running.listener.state)
    assert running.listener.state[0].data == "initializing"
    assert len(running.listener.pose) == 0 or running.listener.state[-1].data != "initializing"


@pytest.mark.parametrize("millimetres", [False, True])
def test_depth_with_stamps_that_differ(node, world, tmp_path, millimetres):
    late = world.write(tmp_path / "late.bag", late_ns=3_000_000, millimetres=millimetres)
    running = node(*ONE, "depth:=/depth/image", sensor="rgbd", sync="approximate")
    play(late)
    # The last pair waits for a later one that tells that it is the best.
    assert wait_for(lambda: len(running.listener.pose) >= len(world.frames) - 2)
    assert world.errors(running.listener.pose)["ate"]["rmse"] < 0.03
    exact = node(*ONE, "depth:=/depth/image", sensor="rgbd")
    play(late)
    assert exact.listener.pose == []  # no two stamps are equal


def test_maps_are_saved_loaded_localized_in_and_left(node, world, bag, tmp_path):
    file = tmp_path / "room.plb"
    running = node(*STEREO, sensor="stereo", map_file=str(file))
    answer = running.call("save_map")
    assert not answer.success and "expected frames before a map is saved" in answer.message
    play(bag)
    assert wait_for(lambda: len(running.listener.pose) == len(world.frames))
    answer = running.call("save_map")
    assert answer.success and answer.message.startswith(str(file)), answer.message
    saved = plumbline.load_map(file).active
    assert f"{len(saved.keyframe_ids)} keyframes" in answer.message
    before = file.read_bytes()

    for service in ("localize", "load_map"):  # the bag again: stamps jump back, the place is known
        running.listener.forget()
        assert running.call(service).success
        play(bag)
        assert wait_for(lambda: running.listener.pose and running.listener.pose[-1].header.stamp
                        == world.stamp(world.frames[-1])), service
        assert world.errors(running.listener.pose)["ate"]["rmse"] < 0.02
        last = pose_matrix(running.listener.pose[-1].pose)
        assert np.linalg.norm(last[:3, 3]) > 0.1  # in the old map, not in one that begins here
        assert file.read_bytes() == before

    running.listener.forget()
    assert running.call("reset").success
    play(bag)
    assert wait_for(lambda: len(running.listener.pose) >= len(world.frames))
    np.testing.assert_allclose(pose_matrix(running.listener.pose[0].pose), np.eye(4), atol=1e-9)
    file.write_bytes(before[:1000])
    answer = running.call("load_map")
    assert not answer.success and "room.plb" in answer.message


def test_a_map_is_loaded_at_the_start_and_the_base_is_where_tf_says(node, world, bag, tmp_path):
    file = tmp_path / "room.plb"
    plumbline.run(rendered(world, tmp_path)).maps.save(file)
    running = node(*STEREO, sensor="stereo", map_file=str(file), localize=True, base_frame="floor")
    play(bag)
    assert wait_for(lambda: running.listener.pose and running.listener.pose[-1].header.stamp
                    == world.stamp(world.frames[-1]))
    # The floor, 1 m below the camera, moves about the origin of the map, not 1 m beside it.
    last = pose_matrix(running.listener.pose[-1].pose)
    truth = world.synth.ground_truth.poses
    moved = np.linalg.inv(truth[0]) @ truth[len(world.frames) - 1]
    mount = np.array([[0, 0, 1, 0], [-1, 0, 0, 0], [0, -1, 0, 1], [0, 0, 0, 1]], dtype=float)
    np.testing.assert_allclose(last, mount @ moved @ np.linalg.inv(mount), atol=0.03)


def rendered(world: World, folder: pathlib.Path) -> pathlib.Path:
    path = folder / "room"
    plumbline.render("room", path, frames=len(world.frames), rate_hz=10, scale=0.5, samples=1,
                     distortion=False)
    return path


@pytest.mark.parametrize("rows, size, encoding, message", [
    (None, None, "16UC1", "expected an image of grey levels or colours, found the encoding '16UC1'"),
    (None, None, "jpeg", "expected an image of grey levels or colours, found the encoding 'jpeg'"),
    (10, None, "mono8", "an image of {width}x10 pixels"),
    (None, 100, "mono8", "expected {pixels} bytes of pixels, found 100")])
def test_what_is_no_image_is_left_out(node, world, rows, size, encoding, message):
    from sensor_msgs.msg import CameraInfo, Image
    running = node(*STEREO, sensor="stereo")
    poses = running.listener.pose
    images = [rospy.Publisher(f"/{side}/image", Image, queue_size=100) for side in ("left", "right")]
    infos = [rospy.Publisher(f"/{side}/camera_info", CameraInfo, queue_size=1, latch=True)
             for side in ("left", "right")]
    for info, right in zip(infos, (False, True)):
        info.publish(world.info(world.frames[0], right))
    assert wait_for(lambda: all(one.get_num_connections() for one in images + infos))

    def send(frame, left):
        images[0].publish(left)
        images[1].publish(world.image(frame, frame.right, "mono8"))

    frames = iter(world.frames)
    for frame in frames:  # until cameras and mounting are known, which come by other connections
        send(frame, world.image(frame, frame.left, "mono8"))
        if wait_for(lambda: poses, 1):
            break
    broken = next(frames)
    image = world.image(broken, broken.left[:rows], encoding)
    image.data = image.data[:size]
    send(broken, image)
    for frame in frames:
        send(frame, world.image(frame, frame.left, "mono8"))
    assert wait_for(lambda: poses and poses[-1].header.stamp == world.stamp(world.frames[-1]))
    assert world.stamp(broken) not in [pose.header.stamp for pose in poses]
    code, said = running.stop()
    assert code == 0
    height, width = broken.left.shape
    assert "/left/image: " + message.format(width=width, pixels=width * height) in said


@pytest.mark.parametrize("parameters, message", [
    ({"sensor": "radar"}, "~sensor: expected mono, stereo or rgbd, found radar"),
    ({"sensor": 3}, "~sensor: expected a text, found a whole number"),
    ({"sync": "soon"}, "~sync: expected exact or approximate, found soon"),
    ({"queue_size": 0}, "~queue_size: expected at least 1, found 0"),
    ({"map_period": "often"}, "~map_period: expected a number, found a text"),
    ({"load": True}, "~map_file: expected a file to load, found none"),
    ({"load": True, "map_file": "/nothing.plb"}, "/nothing.plb"),
    ({"kamera": "tum_fr1"}, "~kamera: expected a parameter of this node (base_frame, camera"),
    ({"camera": "no_such_camera"}, "no_such_camera"),
    ({"options": {"features": {"line_count": "many"}}},
     "features.line_count: expected a whole number, 0 to 5000, found 'many'"),
    ({"options": {"featuers": {"line_count": 3}}}, "featuers"),
    ({"options": [1]}, "~options: expected a group, found a list"),
    ({"config": "/nothing.yaml"}, "/nothing.yaml")])
def test_wrong_parameters_are_told(ros, parameters, message):
    refused = Node(**parameters)
    refused.process.wait(60)
    code, said = refused.stop()
    assert code == 2
    lines = [line for line in said.splitlines() if line.startswith("plumbline_node: ")]
    assert len(lines) == 1 and message in lines[0], said


def test_the_launch_file_with_the_time_of_the_bag(ros, world, bag):
    rospy.set_param("/use_sim_time", True)
    heard = Listener("plumbline")
    launched = subprocess.Popen(
        ["roslaunch", "--wait", "plumbline", "plumbline.launch", "sensor:=stereo",
         "left:=/left/image", "left_info:=/left/camera_info", "right:=/right/image",
         "right_info:=/right/camera_info"], stdout=subprocess.DEVNULL)
    try:
        rospy.wait_for_service("/plumbline/reset", 90)
        play(bag, "--clock", "--rate", "0.5")
        assert wait_for(lambda: len(heard.pose) > len(world.frames) // 3)
        assert world.errors(heard.pose)["ate"]["rmse"] < 0.05
    finally:
        heard.close()
        stop(launched)
        rospy.delete_param("/use_sim_time")


DATA = pathlib.Path(os.environ.get("PLUMBLINE_DATA")
                    or pathlib.Path(__file__).parents[3] / "shared" / "data")


@pytest.mark.skipif(not DATA.is_dir(), reason="there are no recordings")
def test_mh_01_from_a_bag(node, tmp_path):
    import rosbag
    from sensor_msgs.msg import Image
    dataset = plumbline.open(DATA / "euroc" / "MH_01_easy_first250")
    (tmp_path / "camera.yaml").write_text(dataset.calibration.to_yaml())
    frames = 100
    with rosbag.Bag(str(tmp_path / "mh_01.bag"), "w") as out:
        for i in range(frames):
            stamp = rospy.Time(0, 0)
            stamp.secs, stamp.nsecs = divmod(int(dataset.stamps_ns[i]), 10**9)
            frame = dataset[i]
            for topic, pixels in (("/cam0/image_raw", frame.left), ("/cam1/image_raw", frame.right)):
                message = Image(height=pixels.shape[0], width=pixels.shape[1], encoding="mono8",
                                step=pixels.strides[0], data=pixels.tobytes())
                message.header.stamp, message.header.frame_id = stamp, "base_link"
                out.write(topic, message, t=stamp)
    running = node("left/image:=/cam0/image_raw", "right/image:=/cam1/image_raw", sensor="stereo",
                   camera=str(tmp_path / "camera.yaml"))
    play(tmp_path / "mh_01.bag")
    assert wait_for(lambda: len(running.listener.pose) == frames, 240)
    # The camera is the base here: the poses are those of a run on the same frames with the same file:
    # rotations that went through its matrices differ from the recording's in their last digits.
    same = plumbline.open(DATA / "euroc" / "MH_01_easy_first250", camera=str(tmp_path / "camera.yaml"))
    # No measurements of the gyroscope are in the bag.
    causal = plumbline.run(same, stop=frames, imu="off").system.causal_trajectory()
    positions = [[p.pose.position.x, p.pose.position.y, p.pose.position.z]
                 for p in running.listener.pose]
    np.testing.assert_allclose(positions, causal.positions, rtol=0, atol=1e-6)


def test_it_is_found_where_it_is_installed(tmp_path):
    subprocess.run(["cmake", "--install", PACKAGE.parent, "--component", "ros", "--prefix",
                    tmp_path], check=True, stdout=subprocess.DEVNULL)
    found = subprocess.run(
        ["/usr/bin/python3", "-c", "from roslib.packages import find_node; "
         "print(*find_node('plumbline', 'plumbline_node'))"], text=True, capture_output=True,
        env=os.environ | {"ROS_PACKAGE_PATH": str(tmp_path / "share")})
    assert pathlib.Path(found.stdout.strip()).resolve() == \
        tmp_path / "lib" / "plumbline" / "plumbline_node", found.stderr
