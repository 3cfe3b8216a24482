"""Control: what commands do, and ways walked by it, from what is seen; nothing here is told a pose."""

from cogmap.control.look_round import LookRound
from cogmap.control.motor_model import MotorModel
from cogmap.control.posture_reacher import PostureReacher
from cogmap.control.reacher import Reacher
from cogmap.control.reaching import Outcome, Reaching

__all__ = ["LookRound", "MotorModel", "Outcome", "PostureReacher", "Reacher", "Reaching"]
