"""Choice of the pattern generator."""

from walking.body.sole import Sole
from walking.parameters import PatternParameters
from walking.pattern.dcm_pattern import DcmGenerator
from walking.pattern.lipm import Lipm
from walking.pattern.paper_pattern import PaperGenerator
from walking.pattern.pattern import PatternGenerator
from walking.pattern.preview_pattern import PreviewGenerator
from walking.pattern.robust_pattern import RobustGenerator


def make_generator(lipm: Lipm, parameters: PatternParameters, sole: Sole) -> PatternGenerator:
    """Return the pattern generator named by the parameters."""
    if parameters.generator == "preview":
        return PreviewGenerator(lipm, parameters)
    if parameters.generator == "paper":
        return PaperGenerator(lipm, parameters)
    if parameters.generator == "robust":
        return RobustGenerator(lipm, parameters, sole)
    return DcmGenerator(lipm, parameters.dcm_gain)
