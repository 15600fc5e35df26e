"""Poses in files of others, as tables for `recalib calibrate --poses`.

python poses.py samples.yaml  # of MoveIt or easy_handeye: poses.txt and targets.txt
python poses.py "pose_*.yaml" "image-*.png" x,y,z,rx,ry,rz  # a file each: poses.csv
"""

import re
import sys
from glob import glob
from pathlib import Path

import numpy as np
import yaml

MATRIX = "r11,r12,r13,x,r21,r22,r23,y,r31,r32,r33,z"
QUATERNION = [("translation", axis) for axis in "xyz"] + [("rotation", axis) for axis in "xyzw"]

source, *others = sys.argv[1:]
if not others:
    tree = yaml.safe_load(Path(source).read_text())
    samples = [sorted(one.items()) for one in (tree if isinstance(tree, list) else tree["samples"])]
    for column, name in enumerate(("poses.txt", "targets.txt")):
        poses = [sample[column][1] for sample in samples]
        if isinstance(poses[0], dict):  # of easy_handeye: for --convention ros
            poses = [[pose[part][axis] for part, axis in QUATERNION] for pose in poses]
        np.savetxt(name, poses)
else:
    columns = others[1] if len(others) > 1 else MATRIX
    ours, theirs = (  # by the last numbers in their names
        {int(re.findall(r"\d+", path)[-1]): path for path in glob(pattern)}
        for pattern in (source, others[0])
    )
    rows = [f"picture,{columns}"]
    for number in sorted(ours.keys() & theirs.keys()):
        text = Path(ours[number]).read_text().lower().rpartition("data")[2]  # of OpenCV's YAML
        found = re.findall(r"[-+]?[\d.]+(?:e[-+]?\d+)?", text)[: columns.count(",") + 1]
        rows.append(",".join([Path(theirs[number]).name, *found]))
    Path("poses.csv").write_text("\n".join(rows))
