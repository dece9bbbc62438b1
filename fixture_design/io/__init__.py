"""Our files: strict readers that say what is wrong and where, writers that lose nothing, JSON Schemas."""

from typing import TYPE_CHECKING

from fixture_design.io.assembly_file import assembly_from_data, read_assembly
from fixture_design.io.csv_export import write_csv
from fixture_design.io.design_record import design_to_dict
from fixture_design.io.documents import Document, document_of, line_document, read_bytes, read_document
from fixture_design.io.graph_file import graph_to_dict, read_graph, write_graph, write_graphml
from fixture_design.io.json_writer import dumps
from fixture_design.io.layout_file import layout_from_data, layout_text, read_layout, write_layout, write_new_layout
from fixture_design.io.places import Place
from fixture_design.io.problems import ContentError
from fixture_design.io.schemas import json_schema, schema_names
from fixture_design.io.task_file import TASK_ENDINGS, read_task, read_task_or_layout, task_of_part
from fixture_design.io.urdf_export import write_urdf
from fixture_design.io.verdict_record import error_record, verdict_to_dict
from fixture_design.packages import loaded_later

if TYPE_CHECKING:
    from fixture_design.io.classifier_file import classifier_to_dict, read_classifier, write_classifier
    from fixture_design.io.hand_file import MODEL_ENDINGS, read_hand
    from fixture_design.io.log_file import read_log, write_log

#: Names that are loaded when first asked for: a tenth of any start otherwise.
_LATER = {
    "MODEL_ENDINGS": "hand_file",
    "classifier_to_dict": "classifier_file",
    "read_classifier": "classifier_file",
    "read_hand": "hand_file",
    "read_log": "log_file",
    "write_classifier": "classifier_file",
    "write_log": "log_file",
}

__all__ = [
    "MODEL_ENDINGS",
    "TASK_ENDINGS",
    "ContentError",
    "Document",
    "Place",
    "assembly_from_data",
    "classifier_to_dict",
    "design_to_dict",
    "document_of",
    "dumps",
    "error_record",
    "graph_to_dict",
    "json_schema",
    "layout_from_data",
    "layout_text",
    "line_document",
    "read_assembly",
    "read_bytes",
    "read_classifier",
    "read_document",
    "read_graph",
    "read_hand",
    "read_layout",
    "read_log",
    "read_task",
    "read_task_or_layout",
    "schema_names",
    "task_of_part",
    "verdict_to_dict",
    "write_classifier",
    "write_csv",
    "write_graph",
    "write_graphml",
    "write_layout",
    "write_log",
    "write_new_layout",
    "write_urdf",
]

__getattr__ = loaded_later(__name__, _LATER)
