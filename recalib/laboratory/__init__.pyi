"""Names imported at their first use: each is slow to import, or needs an optional package."""

from . import commands as commands
from .hand_eye.calibrating import calibrate_poses as calibrate_poses
from .hand_eye.calibrating import pictures_at as pictures_at
from .hand_eye.proposing import propose_poses as propose_poses
from .live.command import measure_live as measure_live
from .pictures.observe import observe as observe
from .pictures.page_of_pictures import page_of_pictures as page_of_pictures
from .pictures.sessions import calibrate_pictures as calibrate_pictures
from .report.page import page_of as page_of
from .report.recording import recording_of as recording_of
