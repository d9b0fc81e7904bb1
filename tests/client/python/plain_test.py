# SPDX-License-Identifier: MIT
"""The 40 lines of docs/python-plain.md: they plan as the package does, and join fragments and pages."""
import pathlib
import re
import socket
import struct
import subprocess
import sys
import tempfile
import unittest

import support

import camway

_PAGE = (support.SOURCE / "docs" / "python-plain.md").read_text()
_LINES, _USE = re.findall(r"```python\n(.*?)```", _PAGE, re.DOTALL)


def setUpModule():
    unittest.enterModuleContext(support.Daemon())


class PlainTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        types = sorted(map(str, (support.SOURCE / "lcmtypes").glob("*.lcm")))
        subprocess.run(["lcm-gen", "-p", *types], cwd=cls.folder, check=True)

    def run_plain(self, code):
        """Runs code behind the lines of the page; the standard library is all that it finds beside them."""
        (self.folder / "plain.py").write_text(_LINES + code)
        done = subprocess.run([sys.executable, "-B", "-S", "-E", "plain.py"], cwd=self.folder, text=True,
                              capture_output=True, timeout=60, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_they_are_forty(self):
        self.assertLessEqual(len([line for line in _LINES.splitlines() if line.strip()]), 40)

    def test_they_plan_what_the_package_plans(self):
        printed = self.run_plain(_USE + "print([list(map(list, segment.position_m)) for segment in segments])")
        camera = camway.Camera(1.4, 1.0, 0.15)
        keyframes = [camway.Keyframe(position_m=position_m, orientation_wxyz=(0.376, 0, -0.927, 0))
                     for position_m in ((12.5, 1.6, 12.8), (17.5, 1.6, 17.9))]
        with camway.Client() as client:
            path = client.plan(camway.Request("office", camera=camera, keyframes=keyframes)).path
        self.assertEqual(printed.strip(), str([segment.position_m.tolist() for segment in path.segments]))

    def test_they_join_the_pages_of_an_answer(self):
        many = """
keyframes = []
for i in range(300):
    keyframe = camway.keyframe_t()
    keyframe.time_s, keyframe.position_m = float(i), (12.5 + 0.01 * (i % 7), 1.6, 12.8 + 0.01 * (i % 5))
    keyframe.orientation_wxyz = (0.376, 0, -0.927, 0)
    keyframes.append(keyframe)
request.keyframes, request.num_keyframes, request.has_times = keyframes, len(keyframes), True
request.request_id += 1
answer, segments = plan(Bus(), request)
assert answer.num_pages > 1, answer.num_pages
assert all(one.t1_s == next.t0_s for one, next in zip(segments, segments[1:]))
print(answer.num_pages, len(segments), segments[0].t0_s, segments[-1].t1_s)
"""
        pages, segments, begin, end = self.run_plain(_USE + many).split()
        self.assertGreaterEqual(int(segments), 299)
        self.assertEqual((begin, end), ("0.0", "299.0"))

    def test_they_join_fragments_in_any_order(self):
        (self.folder / "plain.py").write_text(_LINES + """
bus = Bus()
print("ready", flush=True)
while True:
    channel, data = bus.receive()
    if channel == "FRAGMENTS":
        print(data.decode(), flush=True)
        break
""")
        message = bytes(range(65, 91)) * 5000
        whole = b"FRAGMENTS\0" + message
        pieces = [whole[at:at + 50_000] for at in range(0, len(whole), 50_000)]
        with subprocess.Popen([sys.executable, "-B", "plain.py"], cwd=self.folder, stdout=subprocess.PIPE,
                              text=True) as process, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            self.assertEqual(process.stdout.readline(), "ready\n")
            for number in (1, 0, 2):
                head = struct.pack(">IIIIHH", 0x4C433033, 9, len(message), 0, number, len(pieces))
                sender.sendto(head + pieces[number], ("239.255.76.67", 7667))
            self.assertEqual(process.stdout.readline().strip(), message.decode())
        self.assertEqual(len(pieces), 3)


if __name__ == "__main__":
    unittest.main()
