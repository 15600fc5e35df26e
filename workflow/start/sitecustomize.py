"""What every job's Python does first: an interrupt ends it at once, as it ends any other program.

Python would answer Ctrl-C with a traceback. What a job leaves in the making goes when the next run
begins, as after any other end.
"""

import signal

signal.signal(signal.SIGINT, signal.SIG_DFL)
