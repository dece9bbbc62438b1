"""Our files: strict readers that say what is wrong and where, writers that lose nothing, JSON Schemas."""

from typing import TYPE_CHECKING

from fixture_design.packages import loaded_later

if TYPE_CHECKING:
    from fixture_design.io.assembly_file import assembly_from_data, read_assembly
    from fixture_design.io.classifier_file import classifier_to_dict, read_classifier, write_classifier
    from fixture_design.io.csv_export import write_csv
    from fixture_design.io.design_record import design_to_dict
    from fixture_design.io.documents import Document, document_of, line_document, read_bytes, read_document
    from fixture_design.io.graph_file import graph_to_dict, read_graph, write_graph, write_graphml
    from fixture_design.io.hand_file import MODEL_ENDINGS, read_hand
    from fixture_design.io.json_writer import dumps
    from fixture_design.io.layout_file import layout_from_data, layout_text, read_layout, write_layout, write_new_layout
    from fixture_design.io.log_file import read_log, write_log
    from fixture_design.io.places import Place
    from fixture_design.io.problems import ContentError
    from fixture_design.io.schemas import json_schema, schema_names
    from fixture_design.io.task_file import TASK_ENDINGS, read_task, read_task_or_layout, task_of_part
    from fixture_design.io.urdf_export import write_urdf
    from fixture_design.io.verdict_record import error_record, verdict_to_dict

#: Names are loaded when first asked for: reading all schemas is a third of any start otherwise.
_HOME = {
    "ContentError": "problems",
    "Document": "documents",
    "MODEL_ENDINGS": "hand_file",
    "Place": "places",
    "TASK_ENDINGS": "task_file",
    "assembly_from_data": "assembly_file",
    "classifier_to_dict": "classifier_file",
    "design_to_dict": "design_record",
    "document_of": "documents",
    "dumps": "json_writer",
    "error_record": "verdict_record",
    "graph_to_dict": "graph_file",
    "json_schema": "schemas",
    "layout_from_data": "layout_file",
    "layout_text": "layout_file",
    "line_document": "documents",
    "read_assembly": "assembly_file",
    "read_bytes": "documents",
    "read_classifier": "classifier_file",
    "read_document": "documents",
    "read_graph": "graph_file",
    "read_hand": "hand_file",
    "read_layout": "layout_file",
    "read_log": "log_file",
    "read_task": "task_file",
    "read_task_or_layout": "task_file",
    "schema_names": "schemas",
    "task_of_part": "task_file",
    "verdict_to_dict": "verdict_record",
    "write_classifier": "classifier_file",
    "write_csv": "csv_export",
    "write_graph": "graph_file",
    "write_graphml": "graph_file",
    "write_layout": "layout_file",
    "write_log": "log_file",
    "write_new_layout": "layout_file",
    "write_urdf": "urdf_export",
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

__getattr__ = loaded_later(__name__, _HOME)
