"""The public names and their modules."""

from .arms import arm_of as arm_of
from .chain import TOLERANCE as TOLERANCE
from .denavit_hartenberg import CONVENTIONS as CONVENTIONS
from .descriptions import STDERR as STDERR
from .descriptions import UrdfFile as UrdfFile
from .descriptions import caught_messages as caught_messages
from .descriptions import find_urdf as find_urdf
from .kinematics import tool_frame as tool_frame
from .meshes import with_own_meshes as with_own_meshes
from .newton import LONGEST_STEP as LONGEST_STEP
from .newton import solve_groups as solve_groups
from .poses import COORDINATES as COORDINATES
from .poses import pose_errors as pose_errors
from .robots import link_end as link_end
