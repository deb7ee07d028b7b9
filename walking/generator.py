"""The choice of the pattern generator."""

from walking.lipm import Lipm
from walking.paper_pattern import PaperGenerator
from walking.parameters import PatternParameters
from walking.pattern import DcmGenerator, PatternGenerator, PreviewGenerator


def make_generator(lipm: Lipm, parameters: PatternParameters) -> PatternGenerator:
    """The generator that the parameters name."""
    if parameters.generator == "preview":
        return PreviewGenerator(lipm, parameters)
    if parameters.generator == "paper":
        return PaperGenerator(lipm, parameters)
    return DcmGenerator(lipm, parameters)
