"""What a recording shows, and when: for those who make it and those who take its pictures."""

ARM = "the arm"  # the view of the first learner's
FRAMES_A_SECOND = 25
POSES = 12  # that the arm visits
ACT = 19.2  # seconds in which it visits them: half of them it moves, half of them it rests there
LEARNING = 10.0  # seconds in which the longest training is shown
BEFORE = ACT - 0.4  # seconds: the arm rests at the last pose, not yet recalibrated
AFTER = BEFORE + LEARNING + ACT  # the same, recalibrated
