# SPDX-License-Identifier: MIT
"""A folder in which the commands of one document are run, as in a checkout after the build."""
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time

PATIENCE_S = 120
_ENDING_FLAGS = ("--check-config", "--help", "--version")  # of camwayd
_COPIED = ("scenes", "lcmtypes", "daemon/process/camwayd.toml")


class Session:
    """Not for a network that others share: daemons are started in it. Run it in tools/scripts/netns.sh."""

    def __init__(self, source, programs):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="camway-documents-"))
        for name in _COPIED:
            target = self.folder / name
            target.parent.mkdir(parents=True, exist_ok=True)
            whole = pathlib.Path(source) / name
            shutil.copytree(whole, target) if whole.is_dir() else shutil.copy(whole, target)
        self._environment = dict(os.environ, PATH=f"{programs}:{os.environ['PATH']}", TZ="UTC",
                                 CAMWAY_CACHE_DIR=str(self.folder / "cache"),
                                 PYTHONPATH=str(pathlib.Path(__file__).parent))
        self._daemon = None
        self._door = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._stop_door()
        self._stop_daemon()
        shutil.rmtree(self.folder)

    def run(self, command):
        """Exit code and output, standard error included. A daemon goes on in the background, and so
        does `camway view`."""
        if command.startswith("camwayd ") and not any(flag in command for flag in _ENDING_FLAGS):
            return self._start_daemon(command)
        if command.startswith("camway view "):
            return self._start_door(command)
        process = self._start(command)
        try:
            exit_code = process.wait(PATIENCE_S)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            return -1, f"it did not end within {PATIENCE_S} s: {self._last_output_of(process)}"
        return exit_code, self._last_output_of(process)

    def interrupt(self, command, meanwhile):
        """Starts `command`, runs `meanwhile`, and interrupts the former."""
        process = self._start("exec " + command)
        exit_code, output = self.run(meanwhile)
        process.send_signal(signal.SIGINT)
        process.wait(PATIENCE_S)
        shown = self._last_output_of(process)
        if exit_code != 0:
            return exit_code, f"{meanwhile}: {output}"
        # A program that does not catch the signal dies of it, which is its end as well.
        return max(process.returncode, 0), shown

    def write(self, name, text):
        file = self.folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
        return file

    def _start(self, command):
        output = tempfile.TemporaryFile("w+", errors="replace")
        process = subprocess.Popen(["bash", "-c", command], cwd=self.folder, env=self._environment,
                                   stdin=subprocess.DEVNULL, stdout=output,
                                   stderr=subprocess.STDOUT, start_new_session=True)
        process.output = output
        return process

    @staticmethod
    def _output_of(process):
        process.output.seek(0)
        return process.output.read().strip()

    def _last_output_of(self, process):
        with process.output:
            return self._output_of(process)

    def _start_daemon(self, command):
        self._stop_daemon()
        self._daemon = self._start("exec " + command)
        give_up_at_s = time.monotonic() + PATIENCE_S
        while self._daemon.poll() is None and time.monotonic() < give_up_at_s:
            if "[info] ready" in self._output_of(self._daemon):
                return 0, ""
            time.sleep(0.05)
        return self._daemon.returncode or -1, self._output_of(self._daemon)

    def _start_door(self, command):
        self._stop_door()
        self._door = self._start(command)
        give_up_at_s = time.monotonic() + PATIENCE_S
        while self._door.poll() is None and time.monotonic() < give_up_at_s:
            if "token=" in self._output_of(self._door):
                return 0, self._output_of(self._door)
            time.sleep(0.05)
        return self._door.returncode or -1, self._output_of(self._door)

    def _stop_door(self):
        if self._door is None:
            return
        if self._door.poll() is None:
            os.killpg(self._door.pid, signal.SIGTERM)
        self._door.wait(PATIENCE_S)
        self._door.output.close()
        self._door = None

    def _stop_daemon(self):
        if self._daemon is None:
            return
        self._daemon.terminate()
        self._daemon.wait(PATIENCE_S)
        self._daemon.output.close()
        self._daemon = None
