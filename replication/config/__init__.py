"""The configuration of a study: its keys with meaning, unit and range, its reading and checking."""

from replication.config.campaign import Ranges as Ranges
from replication.config.campaign import RoughSearch as RoughSearch
from replication.config.damages import Assigned as Assigned
from replication.config.damages import Entry as Entry
from replication.config.damages import damages_among as damages_among
from replication.config.damages import describe as describe
from replication.config.messages import MOST_SHOWN as MOST_SHOWN
from replication.config.messages import InvalidConfiguration as InvalidConfiguration
from replication.config.reading import read_study as read_study
from replication.config.shipped import CAMPAIGN as CAMPAIGN
from replication.config.shipped import DEVIATIONS as DEVIATIONS
from replication.config.shipped import RESULTS as RESULTS
from replication.config.shipped import root_of as root_of
from replication.config.study import Ensemble as Ensemble
from replication.config.study import Measuring as Measuring
from replication.config.study import PaperDamage as PaperDamage
from replication.config.study import Published as Published
from replication.config.study import Source as Source
from replication.config.study import Study as Study
from replication.config.switches import IMPROVED as IMPROVED
from replication.config.switches import RITTER as RITTER
from replication.config.switches import SWITCHES as SWITCHES
from replication.config.values import from_file as from_file
from replication.config.values import from_mapping as from_mapping
from replication.config.values import shown as shown
