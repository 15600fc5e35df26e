"""A table of measurements that grows by whole rows, and stays valid if the process is killed."""

import csv
import fcntl
import io
import os
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from recalib.errors import InvalidFile
from recalib.files.outputs import AnyPath
from recalib.files.storage import path_of, read_file, whole
from recalib.identification.model.observations import Observations
from recalib.laboratory.data_set import data_set
from recalib.laboratory.tables.columns import PICTURE, PICTURES
from recalib.laboratory.tables.description import Description
from recalib.laboratory.tables.measurements import joint_headings, measurements_so_far, read_desired
from recalib.laboratory.tables.table import MOST, table_text
from recalib.nominal.kinematics import Arm
from recalib.station.interface import Pictures


class Record:
    """The rows so far, the postures that a person skipped, and the files that hold them.

    An incomplete last row, from a killed process or a full disk, is dropped; nothing else in an
    existing table is changed. Skipped postures are in a separate file next to the table.

    Args:
        path: of the table, which may exist already.
        arm: its joints are the first columns.
        description: frames, distances and columns that the table cannot express.
        pictures: reads the pictures in the column `picture`; replaces the poses of the table.

    Raises InvalidFile: not such a table, or another process is writing it.
    """

    def __init__(
        self,
        path: AnyPath,
        arm: Arm,
        description: Description,
        pictures: Pictures | None = None,
    ):
        self.path, self._arm, self._description = path_of(path), arm, description
        self.pictures = pictures
        self.observations: Observations | None = None  # the rows; None while there are none
        self.dropped = ""  # the incomplete last row, if there was one
        self._joints = joint_headings(arm, "rad", "m")
        self._skips = self.path.with_name(f"{self.path.stem}_skipped{self.path.suffix}")
        try:
            self._file = os.open(self.path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)
        except OSError as error:
            raise InvalidFile(self.path, error.strerror or "it cannot be written") from None
        try:
            self._start()
        except BaseException:
            os.close(self._file)
            raise

    def __len__(self) -> int:
        return 0 if self.observations is None else len(self.observations)

    def _start(self) -> None:
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise InvalidFile(self.path, "another process writes it") from None
        content = read_file(self.path, MOST)
        self._content = content[: content.rfind(b"\n") + 1]
        self.dropped = content[len(self._content) :].decode("utf-8", "replace")
        if self._content.count(b"\n") == 1:  # a header alone, from before the first row
            self._content = b""
        start = ",".join(self._joints).encode()
        if self._content:
            header = next(csv.reader(io.StringIO(self._content.decode("utf-8-sig"))))
            needed = [*self._joints, *[PICTURE] * (self.pictures is not None)]
            if missing := [name for name in needed if name not in header]:
                raise InvalidFile(
                    self.path, f"column {missing[0]!r} is missing, so rows cannot be added"
                )
            self._header, self.observations = header, self._read(self._content)
        elif not (content.startswith(start) or start.startswith(content)):
            raise InvalidFile(self.path, "it was not started by recalib live")
        os.ftruncate(self._file, len(self._content))
        self.skipped = self._read_skipped()  # (n, joints) rad, m

    def _read_skipped(self) -> np.ndarray:
        if not self._skips.exists():
            return np.zeros((0, len(self._joints)))
        if not self._content:
            reason = f"it has postures that were skipped for {self.path}, which has no rows"
            raise InvalidFile(self._skips, f"{reason}; try: remove it, or another --table")
        joints = read_desired(self._skips, self._arm).joints
        if joints is None:
            raise InvalidFile(self._skips, f"it has no joints; expected: {', '.join(self._joints)}")
        return joints

    def skip(self, posture: np.ndarray) -> None:
        """Record permanently that a person skipped a posture (joints,) [rad, m]."""
        self.skipped = np.vstack([self.skipped, posture])
        with whole(self._skips) as file:
            rows = (dict(zip(self._joints, row, strict=True)) for row in self.skipped.tolist())
            file.write_bytes(table_text(rows))

    def read(
        self, angles: np.ndarray, cells: Mapping[str, float | str]
    ) -> tuple[Observations, bytes]:
        """The rows with a new one, and the text of the new row, which is not yet written.

        The row has the joints (joints,) [rad, m] and the cells measured there, by heading. Raises
        InvalidFile: columns other than before, or cells that are not a measurement.
        """
        names, row = [*self._joints, *map(str, cells)], [*angles.tolist(), *cells.values()]
        header = self._header if len(self) else names
        if sorted(header) != sorted(names):
            raise InvalidFile(
                self.path,
                f"its columns are {', '.join(header)}; the station gives {', '.join(names)}",
            )
        row = [row[names.index(name)] for name in header]
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerows([row] if len(self) else [header, row])
        line = text.getvalue().encode(errors="surrogatepass")  # which `_read` refuses
        return self._read(self._content + line), line

    def write(self, observations: Observations, line: bytes) -> None:
        """Append the row that `read` returned; it is on the disk when this returns.

        Raises InvalidFile if there is no space for it.
        """
        try:
            os.lseek(self._file, len(self._content), os.SEEK_SET)
            if os.write(self._file, line) < len(line):
                raise OSError(None, "there is not enough space for a row")
            os.fsync(self._file)
        except OSError as error:
            os.ftruncate(self._file, len(self._content))
            raise InvalidFile(self.path, error.strerror or "it cannot be written") from None
        if not self._content:
            self._header = next(csv.reader(io.StringIO(line.decode())))
        self._content += line
        self.observations = observations

    def close(self) -> None:
        """Release the table to other processes; remove it if it has no rows."""
        if not self._content:
            self.path.unlink(missing_ok=True)
        os.close(self._file)

    def _read(self, content: bytes) -> Observations:
        rows = measurements_so_far(content, self.path, self._arm, self._description)
        data = data_set(rows, self._description, self._arm)
        if len(data.targets) > 1:
            names = ", ".join(data.targets)
            raise InvalidFile(self.path, f"it has the targets {names}; expected: a single one")
        *before, last = rows.columns.get(PICTURES.name, np.array([""])).tolist()
        if last and last in before:
            reason = f"{last} is in an earlier row; expected: a new file for each picture"
            raise InvalidFile(self.path, reason)
        if self.pictures is None:
            return data.observations
        poses, optics = self.pictures([*before, last])
        return replace(data.observations, measured=poses, optics=optics)
