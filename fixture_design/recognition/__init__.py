"""Contact states from what is measured (thesis chapter 4): no training data, only the cones of the graph's samples.

`sample_cones` has F(q) and A(q) of samples, `state_set` what may be measured in a state (`simplices` of neighbours,
`merging` by Theorem 10, `checking` on denser samples), `discriminants` which faces tell one state from others,
`classifier` asks all of it of a measurement.
"""

from fixture_design.recognition.build import build_classifier, transitions
from fixture_design.recognition.classifier import Classifier, Made, Noise, Recognition, StateClass, Transition
from fixture_design.recognition.export import c_source, numpy_source
from fixture_design.recognition.log import Log, recognize_log
from fixture_design.recognition.measurement import MeasurementSet, Widening, measurement_set
from fixture_design.recognition.recogniser import Recogniser
from fixture_design.recognition.sensor import Sensor
from fixture_design.recognition.signals import Signals

__all__ = [
    "Classifier",
    "Log",
    "Made",
    "MeasurementSet",
    "Noise",
    "Recogniser",
    "Recognition",
    "Sensor",
    "Signals",
    "StateClass",
    "Transition",
    "Widening",
    "build_classifier",
    "c_source",
    "measurement_set",
    "numpy_source",
    "recognize_log",
    "transitions",
]
