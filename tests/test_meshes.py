"""Which files a URDF may bring into a recording, and that its text may be in any encoding."""

import os

import pytest
import rerun as rr
from rerun.chunk import RrdReader

from recalib.laboratory.logged_arm import log_meshes
from recalib.nominal import with_own_meshes

MESH = """solid SECRET
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 1 0
endloop
endfacet
endsolid
"""
SHAPE = '<{0}><geometry><mesh filename="{1}"/></geometry></{0}>'
INSIDE = {
    "beside the URDF": "arm.stl",
    "below it": "./meshes/arm.stl",
    "its package, from above": "package://lab/urdf/arm.stl",
    "a package beside it": "package://meshes/arm.stl",
    "a package of the same workspace": "package://hand/hand.stl",
    "a package where ROS looks": "package://elsewhere/far.STL",
    "another way to write it": "package:///lab/urdf/arm.stl",
    "by its whole path": "file://{root}/lab/urdf/arm.stl",
}
OUTSIDE = {
    "a whole path": "{root}/secret.stl",
    "a whole path as an address": "file://{root}/secret.stl",
    "up and away": "../../secret.stl",
    "out of its package": "package://lab/../secret.stl",
    "out of another package": "package://hand/../secret.stl",
    "no package": "package://bare/bare.stl",
    "a package of the system": "package://etc/hostname",
    "up as a package": "package://../secret.stl",
    "through a link": "link.stl",
    "no mesh": "notes.txt",
    "a pipe": "pipe.stl",
    "nothing": "gone.stl",
    "no name": "",
    "too long a name": "x" * 5000 + ".stl",
    "a circle": "circle.stl",
}


def urdf(name: str, kind: str = "visual", comment: str = "") -> str:
    texture = '<material name="m"><texture filename="/etc/hostname"/></material>'
    shape = SHAPE.format(kind, name)
    return f'<robot name="r"><!--{comment}-->{texture}<link name="base">{shape}</link></robot>'


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Two packages of a workspace, one elsewhere, and what is none."""
    for package in ("lab", "hand", "ros/elsewhere"):
        (tmp_path / package).mkdir(parents=True)
        (tmp_path / package / "package.xml").write_text("<package/>")
    (tmp_path / "bare").mkdir()
    (tmp_path / "lab" / "urdf" / "meshes").mkdir(parents=True)
    for name in ("lab/urdf/arm.stl", "lab/urdf/meshes/arm.stl", "lab/urdf/notes.txt"):
        (tmp_path / name).write_text(MESH)
    for name in ("hand/hand.stl", "ros/elsewhere/far.STL", "bare/bare.stl", "secret.stl"):
        (tmp_path / name).write_text(MESH)
    os.mkfifo(tmp_path / "lab/urdf/pipe.stl")
    (tmp_path / "lab/urdf/link.stl").symlink_to(tmp_path / "secret.stl")
    (tmp_path / "lab/urdf/circle.stl").symlink_to("circle.stl")
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "ros"))
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    return tmp_path


def record(folder, source: bytes, capfd) -> tuple[bytes, list[str]]:
    path = folder / "recording.rrd"
    with rr.RecordingStream("a test") as rec:
        rec.save(path)
        visuals, missing = log_meshes(rec, source, folder / "lab" / "urdf" / "arm.urdf", "arm")
    assert capfd.readouterr().err == "", "another library's warning"
    assert bool(visuals) != bool(missing)
    blobs = b""
    for chunk in RrdReader(path).store().stream().to_chunks():
        batch = chunk.to_record_batch()
        for name in batch.schema.names:
            if name.endswith(":blob"):
                blobs += b"".join(map(bytes, batch.column(name).to_pylist()[0]))
    return blobs, missing


@pytest.mark.parametrize("name", INSIDE.values(), ids=INSIDE)
def test_a_mesh_of_its_own_packages_and_folders_is_recorded(name, folder, capfd):
    recorded, missing = record(folder, urdf(name.format(root=folder)).encode(), capfd)
    assert not missing and recorded == MESH.encode()


@pytest.mark.parametrize("name", OUTSIDE.values(), ids=OUTSIDE)
def test_no_other_file_comes_into_a_recording(name, folder, capfd):
    name = name.format(root=folder)
    recorded, missing = record(folder, urdf(name).encode(), capfd)
    assert missing == [name] and not recorded


def test_what_nobody_draws_is_not_looked_for(folder):
    text, missing = with_own_meshes(urdf("gone.stl", "collision").encode(), folder / "arm.urdf")
    assert missing == [] and b"gone" not in text and b"texture" not in text


@pytest.mark.parametrize("encoding", ["ISO-8859-1", "UTF-16", "GBK"])
def test_a_declared_encoding_is_read(encoding, folder, capfd):
    comment = "机器人" if encoding == "GBK" else "Gerät"
    text = f'<?xml version="1.0" encoding="{encoding}"?>' + urdf("arm.stl", comment=comment)
    recorded, _ = record(folder, text.encode(encoding), capfd)
    assert recorded == MESH.encode()
