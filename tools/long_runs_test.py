#!/usr/bin/env python3
"""Tests tools/long_runs.py."""
import unittest

import long_runs

TABLE = """| round | tracked | RSS | frame |
|---|---|---|---|
| 1 | 300 of 300 | 100 | 20.0 |
| 2 | 300 of 300 | 110 | 22.0 |
| 3 | 300 of 300 | 112 | 24.0 |
| 4 | 300 of 300 | 114 | 26.0 |
| 5 | 300 of 300 | 115 | 40.0 |
"""


class LongRuns(unittest.TestCase):

    def test_whole_minutes_are_means_of_two_rounds(self):
        self.assertEqual(long_runs.read_rooms(TABLE),
                         {1: {"frame": 21, "memory": 105}, 2: {"frame": 25, "memory": 113}})

    def test_a_frame_that_is_not_tracked_ends_it(self):
        with self.assertRaisesRegex(SystemExit, "round 2: 299 of 300 frames are tracked"):
            long_runs.read_rooms(TABLE.replace("| 2 | 300 of", "| 2 | 299 of"))

    def test_a_fifth_more_is_allowed(self):
        rows = {1: {"frame": 10.0}, 10: {"frame": 12.0}}
        self.assertFalse(long_runs.grows("a frame", rows, "frame", 1))
        rows[10]["frame"] = 12.1
        self.assertTrue(long_runs.grows("a frame", rows, "frame", 1))

    def test_the_figure_has_all_curves(self):
        road = {1: {"keyframe": 10, "snapshot": 1, "end": 4000},
                10: {"keyframe": 11, "snapshot": 1, "end": 40000}}
        rooms = {1: {"frame": 20, "memory": 100}, 10: {"frame": 22, "memory": 120}}
        figure = long_runs.draw(road, rooms)
        for legend in ("mapping a keyframe", "a snapshot", "the end", "a frame in rooms", "memory"):
            self.assertIn(legend, figure)


if __name__ == "__main__":
    unittest.main()
