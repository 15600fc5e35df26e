"""What every job's Python does first: an interrupt ends it at once, as it ends any other program.

Most of a job's start is imports, and Python would answer Ctrl-C there with their traceback.
`workflow/scripts/call.py` catches an interrupt as soon as there is something to end in order.
"""

import signal

signal.signal(signal.SIGINT, signal.SIG_DFL)
