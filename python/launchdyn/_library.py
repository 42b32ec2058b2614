"""The C library: where it is found, its structs, and what its functions take and return.

Everything here mirrors include/launchdyn/*.h; a test compares both.
"""

from __future__ import annotations

import ctypes
import os
import sysconfig
from ctypes import (CFUNCTYPE, POINTER, Structure, c_bool, c_char, c_char_p, c_double, c_int,
                    c_int64, c_size_t, c_ubyte, c_void_p)
from pathlib import Path
from typing import Any, Iterator

#: Of the interface that this package was written for; the shared library's name carries it.
INTERFACE = 1
#: The version of this package, which is that of the library it goes with.
VERSION = "0.1.0"


# ---- structs, named as in the headers

class ld_error(Structure):
    _fields_ = [("status", c_int), ("text", c_char * 640)]


class ld_message(Structure):
    _fields_ = [("file", c_char_p), ("line", c_int), ("column", c_int), ("path", c_char_p),
                ("text", c_char_p), ("source", c_char_p)]


class ld_messages(Structure):
    _fields_ = [("count", c_size_t), ("item", POINTER(ld_message))]


class ld_key(Structure):
    _fields_ = [("path", c_char_p), ("unit", c_char_p), ("description", c_char_p),
                ("expected", c_char_p), ("low", c_double), ("high", c_double),
                ("required", c_int)]


class ld_column(Structure):
    _fields_ = [("name", c_char_p), ("unit", c_char_p), ("description", c_char_p)]


class ld_quantity(Structure):
    _fields_ = [("name", c_char_p), ("unit", c_char_p), ("description", c_char_p),
                ("value", c_double)]


class ld_mode(Structure):
    _fields_ = [("frequency", c_double), ("damping", c_double), ("real", c_double),
                ("shape", c_char * 64)]


class ld_pole(Structure):
    _fields_ = [("real", c_double), ("imaginary", c_double), ("shape", c_char * 64)]


class ld_base_frame(Structure):
    _fields_ = [("position", c_double * 3), ("quaternion", c_double * 4),
                ("velocity", c_double * 3), ("rate", c_double * 3)]


class ld_base_wrench(Structure):
    _fields_ = [("force", c_double * 3), ("moment", c_double * 3)]


class ld_event(Structure):
    _fields_ = [("kind", c_int), ("t", c_double), ("rocket", c_int), ("part", c_int)]


#: Of ld_run_options: gets the share done, returns whether to continue.
SHARE_TOLD = CFUNCTYPE(c_bool, c_void_p, c_double)


class ld_run_options(Structure):
    _fields_ = [("sink", c_void_p), ("self", c_void_p), ("progress", SHARE_TOLD),
                ("base", POINTER(ld_base_frame)), ("reserved", c_void_p * 4)]


class ld_study_counts(Structure):
    _fields_ = [("samples", c_int64), ("look", c_int64), ("enough", c_bool), ("done", c_int64),
                ("failed", c_int64), ("now", c_int64)]


#: Of ld_study_options: gets how far it is; asked whether to continue, as ld_watch is.
COUNTS_TOLD = CFUNCTYPE(None, c_void_p, POINTER(ld_study_counts))
GO_ON = CFUNCTYPE(c_bool, c_void_p)


class ld_study_options(Structure):
    _fields_ = [("threads", c_int), ("shard", c_int), ("shards", c_int), ("self", c_void_p),
                ("progress", COUNTS_TOLD), ("go_on", GO_ON), ("expiry", c_double),
                ("reserved", c_void_p * 3)]


class ld_study_range(Structure):
    _fields_ = [("first", c_int64), ("last", c_int64)]


class ld_fit_key(Structure):
    _fields_ = [("path", c_char_p), ("from", c_char_p), ("to", c_char_p), ("mean", c_char_p),
                ("deviation", c_char_p)]


class ld_fit_counts(Structure):
    _fields_ = [("launches", c_int64), ("chi2", c_double), ("stage", c_char_p)]


FIT_TOLD = CFUNCTYPE(None, c_void_p, POINTER(ld_fit_counts))


class ld_fit_options(Structure):
    _fields_ = [("folder", c_char_p), ("threads", c_int), ("starts", c_int), ("seed", c_int64),
                ("self", c_void_p), ("progress", FIT_TOLD), ("go_on", GO_ON),
                ("reserved", c_void_p * 4)]


class ld_derivative_key(Structure):
    _fields_ = [("path", c_char_p), ("step", c_char_p)]


DERIVATIVES_TOLD = CFUNCTYPE(None, c_void_p, c_int, c_int)


class ld_derivative_options(Structure):
    _fields_ = [("threads", c_int), ("self", c_void_p), ("progress", DERIVATIVES_TOLD),
                ("go_on", GO_ON), ("reserved", c_void_p * 4)]


class ld_optimise_counts(Structure):
    _fields_ = [("launches", c_int64), ("candidates", c_int), ("least", c_double),
                ("stage", c_char_p)]


OPTIMISE_TOLD = CFUNCTYPE(None, c_void_p, POINTER(ld_optimise_counts))


class ld_optimise_options(Structure):
    _fields_ = [("folder", c_char_p), ("threads", c_int), ("self", c_void_p),
                ("progress", OPTIMISE_TOLD), ("go_on", GO_ON), ("reserved", c_void_p * 4)]


class ld_study_view(Structure):
    _fields_ = [("what", c_char_p), ("sensitivity", c_bool), ("json", c_bool),
                ("index", c_ubyte), ("measured", c_char_p), ("against", c_char_p),
                ("csv", c_char_p), ("over", c_char_p)]


class ld_study_column(Structure):
    _fields_ = [("name", c_char_p), ("unit", c_char_p), ("factor", c_bool),
                ("per_rocket", c_bool), ("seed", c_bool)]


class ld_study_point(Structure):
    _fields_ = [("number", c_int64), ("text", POINTER(c_char_p)), ("asked", c_int64),
                ("done", c_int64), ("failed", c_int64)]


class ld_study_values(Structure):
    _fields_ = [("count", c_size_t), ("sample", POINTER(c_int64)), ("rocket", POINTER(c_int)),
                ("value", POINTER(POINTER(c_double)))]


class ld_estimate(Structure):
    _fields_ = [("value", c_double), ("low", c_double), ("high", c_double)]


class ld_study_statistics(Structure):
    _fields_ = [("count", c_size_t), ("groups", c_size_t), ("mean", ld_estimate),
                ("deviation", ld_estimate), ("skewness", c_double), ("least", c_double),
                ("greatest", c_double), ("quantile", ld_estimate * 3)]


class ld_study_influence(Structure):
    _fields_ = [("factor", c_char_p), ("first", ld_estimate), ("total", ld_estimate),
                ("together", ld_estimate), ("mu_star", ld_estimate), ("mu", ld_estimate),
                ("sigma", c_double), ("count", c_size_t), ("groups", c_size_t)]


class ld_study_footprint(Structure):
    _fields_ = [("share", c_double), ("needed", c_double), ("independent", c_double),
                ("stated", c_bool), ("content", ld_estimate), ("area", ld_estimate),
                ("distance", ld_estimate)]


class ld_study_over(Structure):
    _fields_ = [("result", c_char_p), ("over", c_char_p), ("against", c_char_p),
                ("statistic", c_char_p), ("reserved", c_void_p * 4)]


class ld_study_cell(Structure):
    _fields_ = [("text", c_char_p * 2), ("number", c_double * 2), ("unit", c_char_p * 2),
                ("estimate", ld_estimate), ("count", c_size_t), ("groups", c_size_t),
                ("points", c_int), ("reference", c_bool)]


class ld_report(Structure):
    _fields_ = [("bytes", c_size_t), ("pixels", c_double), ("note_count", c_int),
                ("note", (c_char * 256) * 8)]


class ld_loop_margins(Structure):
    _fields_ = [(name, c_double) for name in
                ("raise", "raise_at", "lower", "lower_at", "phase", "crossover", "delay",
                 "bandwidth", "peak", "peak_at")]


class ld_watch(Structure):
    _fields_ = [("go_on", GO_ON), ("self", c_void_p)]


class ld_response_wish(Structure):
    _fields_ = [("what", POINTER(c_char_p)), ("what_count", c_size_t), ("input", c_char_p),
                ("from", c_double), ("to", c_double), ("slowest", c_double),
                ("fastest", c_double), ("step", c_double), ("loop", c_char_p),
                ("density", c_char_p), ("exit", c_bool), ("friction", c_bool), ("draws", c_int),
                ("watch", POINTER(ld_watch))]


class ld_fmu_options(Structure):
    _fields_ = [("part", c_int), ("version", c_int), ("outputs", c_char_p),
                ("parameters", c_char_p), ("arrays", c_bool), ("reserved", c_void_p * 3)]


class ld_stretch(Structure):
    _fields_ = [("from", c_double), ("to", c_double), ("step", c_double)]


class ld_wind_section(Structure):
    _fields_ = [("height", c_double), ("top", c_double), ("length", c_double),
                ("step", c_double), ("rocket", c_int)]


class ld_figure(Structure):
    _fields_ = [("name", c_char_p), ("description", c_char_p)]


class ld_scene(Structure):
    _fields_ = [("magnify", c_double), ("slower", c_double)]


class ld_picture(Structure):
    _fields_ = [("folder", POINTER(c_char_p)), ("folder_count", c_size_t),
                ("figure", POINTER(c_char_p)), ("figure_count", c_size_t), ("from", c_double),
                ("to", c_double), ("note", c_void_p), ("style", c_char_p), ("width", c_double),
                ("scene", POINTER(ld_scene))]


class ld_compare_options(Structure):
    _fields_ = [("sensors", c_char_p), ("study", c_char_p), ("samples", c_int),
                ("refine", c_bool), ("rocket", c_int), ("progress", SHARE_TOLD),
                ("self", c_void_p), ("reserved", c_void_p * 4)]


class ld_validation(Structure):
    _fields_ = [("error", c_double), ("u_num", c_double), ("u_input", c_double),
                ("u_data", c_double), ("u_val", c_double), ("limit", c_double),
                ("verdict", c_int)]


class ld_compared_series(Structure):
    _fields_ = [("name", c_char_p), ("unit", c_char_p), ("log_unit", c_char_p),
                ("factor", c_double), ("count", c_size_t), ("t", POINTER(c_double)),
                ("measured", POINTER(c_double)), ("simulated", POINTER(c_double)),
                ("u_val", POINTER(c_double)), ("of", ld_validation), ("mean", c_double),
                ("largest", c_double), ("t_largest", c_double), ("saturated", c_size_t),
                ("gaps", c_size_t), ("outside", c_size_t), ("bias", c_double),
                ("bias_uncertainty", c_double), ("column", c_char_p)]


class ld_compared_result(Structure):
    _fields_ = [("name", c_char_p), ("unit", c_char_p), ("log_unit", c_char_p),
                ("factor", c_double), ("measured", c_double), ("simulated", c_double),
                ("of", ld_validation)]


class ld_compared_clock(Structure):
    _fields_ = [("offset", c_double), ("uncertainty", c_double), ("found_by", c_char_p)]


class ld_section(Structure):  # of the unions the members of planes
    _fields_ = [("form", c_int), ("from", c_double), ("bore_radius", c_double),
                ("outer_radius", c_double), ("area", c_double),
                ("bending_stiffness_y", c_double), ("bending_stiffness_z", c_double),
                ("mass_per_length", c_double), ("axial_stiffness", c_double),
                ("bending_stiffness", c_double), ("torsion_stiffness", c_double),
                ("polar_inertia", c_double)]


class ld_mstmm_beam(Structure):
    _fields_ = [("length", c_double), ("section_count", c_int), ("section", POINTER(ld_section)),
                ("bending", c_int), ("torsion", c_int), ("axial", c_int), ("elements", c_int),
                ("damping", c_double), ("span", c_int), ("geometric_stiffness", c_int),
                ("reserved_number", c_int), ("shear_coefficient", c_double),
                ("reserved", c_void_p * 2)]


class ld_mstmm_element(Structure):
    _fields_ = [("name", c_char_p), ("parent", c_char_p), ("at", c_double * 3),
                ("attitude", c_double * 4), ("hinge", c_int), ("axis", c_double * 3),
                ("axis_2", c_double * 3), ("stiffness", c_double * 6), ("damping", c_double * 6),
                ("rest", c_double * 2), ("mass", c_double), ("center", c_double * 3),
                ("inertia", c_double * 6), ("beam", POINTER(ld_mstmm_beam)),
                ("prescribed", c_int), ("reserved", c_void_p * 3)]


class ld_mstmm_end(Structure):
    _fields_ = [("element", c_char_p), ("at", c_double * 3), ("attitude", c_double * 4)]


class ld_mstmm_loop(Structure):
    _fields_ = [("name", c_char_p), ("first", ld_mstmm_end), ("second", ld_mstmm_end),
                ("joint", c_int), ("axis", c_double * 3), ("axis_2", c_double * 3),
                ("stiffness", c_double * 6), ("damping", c_double * 6), ("rest", c_double * 2),
                ("reserved", c_void_p * 4)]


class ld_mstmm_description(Structure):
    _fields_ = [("elements", POINTER(ld_mstmm_element)), ("element_count", c_int),
                ("loop_count", c_int), ("loops", POINTER(ld_mstmm_loop)),
                ("gravity", c_double * 3), ("reserved", c_void_p * 4)]


class ld_mstmm_assembly(Structure):
    _fields_ = [("iterations", c_int), ("freedoms", c_int), ("held", c_int),
                ("redundant", c_int), ("gap", c_double), ("turn", c_double),
                ("singularity", c_double)]


class ld_mstmm_energies(Structure):
    _fields_ = [("kinetic", c_double), ("potential", c_double), ("elastic", c_double)]


class ld_mstmm_point(Structure):
    _fields_ = [("position", c_double * 3), ("velocity", c_double * 3),
                ("attitude", c_double * 4), ("rate", c_double * 3)]


class ld_mstmm_mode(Structure):
    _fields_ = [("frequency", c_double), ("damping", c_double), ("rate", c_double)]


#: Of ld_mstmm_settings: gives drive forces; what is prescribed; receives the state, other than 0
#: stops.
MSTMM_DRIVE = CFUNCTYPE(None, c_double, POINTER(c_double), POINTER(c_double), POINTER(c_double),
                        POINTER(c_double), c_void_p)
MSTMM_MOTION = CFUNCTYPE(None, c_double, POINTER(c_double), POINTER(c_double), POINTER(c_double),
                         c_void_p)
MSTMM_SINK = CFUNCTYPE(c_int, c_double, POINTER(c_double), POINTER(c_double), c_void_p)


class ld_mstmm_settings(Structure):
    _fields_ = [("rtol", c_double), ("atol", c_double), ("output_step", c_double),
                ("drive", MSTMM_DRIVE), ("sink", MSTMM_SINK), ("context", c_void_p),
                ("motion", MSTMM_MOTION), ("reserved", c_void_p * 3)]


KEY_TAKER = CFUNCTYPE(None, c_void_p, POINTER(ld_key))
QUANTITY_TAKER = CFUNCTYPE(None, c_void_p, POINTER(ld_quantity))


# ---- functions: what they return, what they take; every handle and FILE is a c_void_p

_handle, _handles = c_void_p, POINTER(c_void_p)
_text, _texts, _number = c_char_p, POINTER(c_char_p), POINTER(c_double)
_error, _messages = POINTER(ld_error), POINTER(ld_messages)

FUNCTIONS: dict[str, tuple[Any, list[Any]]] = {
    "ld_version": (_text, []),
    "ld_version_number": (c_int, []),
    "ld_suggested_name": (_text, [_text, c_void_p, c_size_t]),
    "ld_current_name": (_text, [_text, c_void_p, c_size_t]),
    "ld_nearest_name": (_text, [_text, _texts, c_size_t]),
    "ld_text_open": (c_void_p, [POINTER(c_void_p), POINTER(c_size_t)]),
    "ld_text_close": (c_int, [c_void_p]),
    "ld_free": (None, [c_void_p]),
    # scenario.h
    "ld_messages_free": (None, [_messages]),
    "ld_scenario_explain": (c_bool, [_handle, _error, _messages]),
    "ld_scenario_read": (c_int, [_text, _texts, c_size_t, _handles, _messages]),
    "ld_scenario_read_text": (c_int, [_text, c_size_t, _text, _text, _texts, c_size_t, _handles,
                                      _messages]),
    "ld_scenario_read_source": (c_int, [_handle, c_int, _handles, _messages]),
    "ld_scenario_notes": (c_int, [_handle, c_int, c_int, _messages]),
    "ld_scenario_keys": (None, [KEY_TAKER, c_void_p]),
    "ld_scenario_points": (c_int, [_handle]),
    "ld_scenario_point_name": (None, [_handle, c_int, c_void_p, c_size_t]),
    "ld_model_new": (c_int, [_texts, c_size_t, _handles, _messages]),
    "ld_model_derive": (c_int, [_handle, _texts, c_size_t, _handles, _messages]),
    "ld_model_number": (c_int, [_handle, _text, _number, _error]),
    "ld_model_text": (c_int, [_handle, _text, c_void_p, c_size_t, _error]),
    "ld_model_table": (c_int, [_handle, _text, POINTER(_number), POINTER(c_size_t),
                               POINTER(c_size_t), _error]),
    "ld_model_source": (_handle, [_handle]),
    "ld_model_has_launcher": (c_bool, [_handle]),
    "ld_model_has_vehicle": (c_bool, [_handle]),
    "ld_model_print": (None, [_handle, c_void_p]),
    "ld_model_describe": (None, [_handle, c_void_p]),
    "ld_model_free": (None, [_handle]),
    # simulation.h
    "ld_simulation_create": (c_int, [_handle, _handles, _error]),
    "ld_simulation_free": (None, [_handle]),
    "ld_simulation_run": (c_int, [_handle, POINTER(ld_run_options), _handle, _error]),
    "ld_simulation_tube_modes": (c_int, [_handle, POINTER(ld_mode), c_int]),
    "ld_simulation_system_modes": (c_int, [_handle, POINTER(ld_mode), c_int, POINTER(c_int),
                                           POINTER(ld_pole), c_int, POINTER(c_int), _error]),
    "ld_simulation_describe": (None, [_handle, c_void_p]),
    "ld_simulation_columns": (c_size_t, [_handle, POINTER(POINTER(ld_column))]),
    # run.h
    "ld_run_begin": (c_int, [_handle, POINTER(ld_run_options), _handles, _error]),
    "ld_run_advance": (c_int, [_handle, c_double, _error]),
    "ld_run_advance_to_event": (c_int, [_handle, c_double, POINTER(ld_event), _error]),
    "ld_run_time": (c_double, [_handle]),
    "ld_run_is_finished": (c_bool, [_handle]),
    "ld_run_number": (c_int, [_handle, _text, _number, _error]),
    "ld_run_row": (c_int, [_handle, _number, _error]),
    "ld_run_summary": (_handle, [_handle]),
    "ld_run_ignite": (c_int, [_handle, c_double, _error]),
    "ld_run_set_base": (c_int, [_handle, POINTER(ld_base_frame), _error]),
    "ld_run_base_wrench": (c_int, [_handle, POINTER(ld_base_wrench), _error]),
    "ld_run_save": (c_int, [_handle, c_void_p, c_size_t, POINTER(c_size_t), _error]),
    "ld_run_load": (c_int, [_handle, POINTER(ld_run_options), c_void_p, c_size_t, _handles,
                            _error]),
    "ld_run_end": (c_int, [_handle, _handle, _error]),
    # vehicle_run.h
    "ld_vehicle_run_begin": (c_int, [_handle, _handles, _error]),
    "ld_vehicle_run_end": (None, [_handle]),
    "ld_vehicle_run_advance": (c_int, [_handle, c_double, _error]),
    "ld_vehicle_run_time": (c_double, [_handle]),
    "ld_vehicle_run_set_wrench": (c_int, [_handle, POINTER(ld_base_wrench), _error]),
    "ld_vehicle_run_wrench": (c_int, [_handle, POINTER(ld_base_wrench), _error]),
    "ld_vehicle_run_frame": (c_int, [_handle, POINTER(ld_base_frame), _error]),
    "ld_vehicle_run_columns": (c_size_t, [_handle, POINTER(POINTER(ld_column))]),
    "ld_vehicle_run_row": (c_int, [_handle, _number, _error]),
    # summary.h, history.h
    "ld_summary_new": (_handle, []),
    "ld_summary_free": (None, [_handle]),
    "ld_summary_number": (c_int, [_handle, _text, _number, _error]),
    "ld_summary_each": (None, [_handle, QUANTITY_TAKER, c_void_p]),
    "ld_summary_rockets": (c_int, [_handle]),
    "ld_summary_stopped": (_text, [_handle]),
    "ld_summary_note": (_text, [_handle, c_int]),
    "ld_history_new": (_handle, [c_void_p]),
    "ld_history_free": (None, [_handle]),
    "ld_history_sink": (c_void_p, [_handle]),
    "ld_history_rows": (c_size_t, [_handle]),
    "ld_history_columns": (POINTER(ld_column), [_handle, POINTER(c_size_t)]),
    "ld_history_column": (c_void_p, [_handle, _text, POINTER(c_size_t)]),
    "ld_history_flight": (_handle, [_handle, c_int]),
    # output.h, report.h, fmu.h
    "ld_output_open": (c_int, [_text, _handle, c_bool, _handles, _error]),
    "ld_output_sink": (c_void_p, [_handle]),
    "ld_output_finish": (c_int, [_handle, _handle, _error]),
    "ld_output_discard": (None, [_handle]),
    "ld_summary_print": (None, [_handle, _handle, c_void_p]),
    "ld_report_write": (c_int, [_text, _text, POINTER(ld_report), _error]),
    "ld_report_write_studies": (c_int, [_texts, c_size_t, _text, POINTER(ld_report), _error]),
    "ld_fit_create": (c_int, [_handle, POINTER(ld_fit_key), c_size_t, _texts, c_size_t, _handles,
                              _error]),
    "ld_fit_add_logs": (c_int, [_handle, _texts, _texts, c_size_t, _error]),
    "ld_fit_draw": (c_int, [_handle, _text, _error]),
    "ld_fit_run": (c_int, [_handle, POINTER(ld_fit_options), _error]),
    "ld_fit_print": (None, [_handle, c_void_p]),
    "ld_fit_print_json": (None, [_handle, c_void_p]),
    "ld_fit_free": (None, [_handle]),
    "ld_derivatives_find": (c_int, [_handle, POINTER(ld_derivative_key), c_size_t,
                                    POINTER(ld_derivative_options), _handles, _error]),
    "ld_derivatives_free": (None, [_handle]),
    "ld_derivatives_print": (c_int, [_handle, _text, c_void_p, _error]),
    "ld_derivatives_print_json": (c_int, [_handle, _text, c_void_p, _error]),
    "ld_optimise_create": (c_int, [_handle, _handles, _error]),
    "ld_optimise_run": (c_int, [_handle, POINTER(ld_optimise_options), _error]),
    "ld_optimise_print": (None, [_handle, c_void_p]),
    "ld_optimise_print_json": (None, [_handle, c_void_p]),
    "ld_optimise_plot": (c_int, [_handle, _text, _error]),
    "ld_optimise_free": (None, [_handle]),
    "ld_fmu_export": (c_int, [_handle, POINTER(ld_fmu_options), _text, _error]),
    "ld_figure_at": (POINTER(ld_figure), [c_size_t]),
    "ld_plot": (c_int, [POINTER(ld_picture), _text, _error]),
    # response.h, loop.h; arrays of numpy are a c_void_p
    "ld_response_create": (c_int, [_handle, c_double, c_double, _handles, _error]),
    "ld_response_free": (None, [_handle]),
    "ld_response_inputs": (c_size_t, [_handle, POINTER(POINTER(ld_column))]),
    "ld_response_friction": (c_int, [_handle, c_bool, _error]),
    "ld_response_columns": (c_size_t, [_handle, POINTER(POINTER(ld_column))]),
    "ld_response_choose": (c_int, [_handle, _texts, c_size_t, _error]),
    "ld_response_gain": (c_int, [_handle, c_double, _text, c_void_p, c_size_t, c_void_p, _error]),
    "ld_response_on_road": (c_int, [_handle, c_double, c_void_p, c_void_p, _error]),
    "ld_response_density": (c_int, [_handle, c_double, c_void_p, c_size_t, c_void_p, _error]),
    "ld_response_random": (c_int, [_handle, c_double, _text, c_void_p, c_void_p, c_size_t,
                                   c_void_p, c_void_p, _error]),
    "ld_response_exit": (c_int, [_handle, c_double, c_int, _texts, c_size_t, c_void_p, c_void_p,
                                 _error]),
    "ld_response_watch": (None, [_handle, POINTER(ld_watch)]),
    "ld_loop_create": (c_int, [_handle, _text, _handles, _error]),
    "ld_loop_free": (None, [_handle]),
    "ld_loop_points": (c_int, [_handle, c_void_p, c_size_t, c_void_p, _error]),
    "ld_loop_rejection": (c_int, [_handle, c_void_p, c_size_t, c_void_p, _error]),
    "ld_loop_margins_of": (None, [_handle, POINTER(ld_loop_margins)]),
    # response_view.h, environment.h
    "ld_response_view_create": (c_int, [_handle, POINTER(ld_response_wish), _handles, _error]),
    "ld_response_view_free": (None, [_handle]),
    "ld_response_view_print": (None, [_handle, c_void_p]),
    "ld_response_view_write": (c_int, [_handle, _text, _error]),
    "ld_response_view_draw": (c_int, [_handle, _text, _error]),
    "ld_road_view_create": (c_int, [_handle, ld_stretch, _handles, _error]),
    "ld_road_view_free": (None, [_handle]),
    "ld_road_view_print": (None, [_handle, c_void_p]),
    "ld_road_view_write": (c_int, [_handle, _text, _error]),
    "ld_road_view_draw": (c_int, [_handle, _text, _error]),
    "ld_wind_view_create": (c_int, [_handle, ld_wind_section, _handles, _error]),
    "ld_wind_view_free": (None, [_handle]),
    "ld_wind_view_print": (None, [_handle, c_void_p]),
    "ld_wind_view_write": (c_int, [_handle, _text, _error]),
    "ld_wind_view_draw": (c_int, [_handle, _text, _error]),
    # study.h, study_data.h
    "ld_study_read": (c_int, [_text, _texts, c_size_t, _handles, _messages]),
    "ld_study_read_text": (c_int, [_text, c_size_t, _text, _text, _texts, c_size_t, _handles,
                                   _messages]),
    "ld_study_read_source": (c_int, [_handle, _handles, _messages]),
    "ld_study_free": (None, [_handle]),
    "ld_study_model": (_handle, [_handle]),
    "ld_study_run": (c_int, [_handle, _text, POINTER(ld_study_options),
                             POINTER(ld_study_counts), _error]),
    "ld_study_join": (c_int, [_handle, _text, POINTER(ld_study_options),
                              POINTER(ld_study_counts), _error]),
    "ld_study_show_statistic": (c_int, [_text, _text, POINTER(ld_study_view), c_void_p, _error]),
    "ld_study_run_range": (c_int, [_handle, POINTER(ld_study_range), POINTER(ld_study_options),
                                   _handles, POINTER(c_size_t), _error]),
    "ld_study_pack": (c_int, [_handle, _handles, POINTER(c_size_t), _error]),
    "ld_study_unpack": (c_int, [c_void_p, c_size_t, _handles, _messages]),
    "ld_study_keeper_open": (c_int, [_handle, _text, _handles, _error]),
    "ld_study_keeper_next": (c_bool, [_handle, POINTER(ld_study_range)]),
    "ld_study_keeper_put": (c_int, [_handle, c_void_p, c_size_t, _error]),
    "ld_study_keeper_counts": (None, [_handle, POINTER(ld_study_counts)]),
    "ld_study_keeper_close": (c_int, [_handle, _error]),
    "ld_study_merge": (c_int, [_text, c_void_p, _error]),
    "ld_study_export": (c_int, [_text, _text, _text, _error]),
    "ld_study_export_footprint": (c_int, [_text, _text, _error]),
    "ld_study_sample": (c_int, [_handle, c_int64, _handles, _error]),
    "ld_sample_model": (_handle, [_handle]),
    "ld_sample_free": (None, [_handle]),
    "ld_study_data_open": (c_int, [_text, _handles, _error]),
    "ld_study_data_close": (None, [_handle]),
    "ld_study_data_column": (POINTER(ld_study_column), [_handle, c_int]),
    "ld_study_data_swept": (_text, [_handle, c_int]),
    "ld_study_data_point": (POINTER(ld_study_point), [_handle, c_int]),
    "ld_study_data_values": (c_int, [_handle, c_int, _texts, c_size_t,
                                     POINTER(POINTER(ld_study_values)), _error]),
    "ld_study_data_statistics": (c_int, [_handle, c_int, _text,
                                         POINTER(POINTER(ld_study_statistics)), _error]),
    "ld_study_data_footprint": (c_int, [_handle, c_int, c_double,
                                        POINTER(POINTER(ld_study_footprint)), _error]),
    "ld_study_data_influences": (c_int, [_handle, c_int, _text,
                                         POINTER(POINTER(ld_study_influence)), POINTER(c_size_t),
                                         _error]),
    "ld_study_data_pool": (c_int, [_handle, POINTER(ld_study_over),
                                   POINTER(POINTER(ld_study_cell)), POINTER(c_size_t), _error]),
    "ld_study_data_sensitivity": (c_int, [_handle, c_int, _text, _text, POINTER(ld_estimate),
                                          _error]),
    # compare.h
    "ld_compare": (c_int, [_text, _text, POINTER(ld_compare_options), _handles, _error]),
    "ld_comparison_free": (None, [_handle]),
    "ld_comparison_series": (POINTER(ld_compared_series), [_handle, c_int]),
    "ld_comparison_result": (POINTER(ld_compared_result), [_handle, c_int]),
    "ld_comparison_clock": (POINTER(ld_compared_clock), [_handle]),
    "ld_comparison_note": (_text, [_handle, c_int]),
    "ld_comparison_print": (None, [_handle, c_void_p]),
    "ld_comparison_draw": (c_int, [_handle, _text, _error]),
    # mstmm.h; arrays of numpy are a c_void_p
    "ld_mstmm_build": (c_int, [POINTER(ld_mstmm_description), _handles, _error]),
    "ld_mstmm_free": (None, [_handle]),
    "ld_mstmm_coordinate_count": (c_int, [_handle]),
    "ld_mstmm_speed_count": (c_int, [_handle]),
    "ld_mstmm_coordinate_offset": (c_int, [_handle, c_int]),
    "ld_mstmm_speed_offset": (c_int, [_handle, c_int]),
    "ld_mstmm_reference": (None, [_handle, c_void_p]),
    "ld_mstmm_assemble": (c_int, [_handle, c_void_p, c_void_p, c_void_p,
                                  POINTER(ld_mstmm_assembly), _error]),
    "ld_mstmm_accelerations": (c_int, [_handle, c_void_p, c_void_p, c_void_p, c_void_p, c_void_p,
                                       _error]),
    "ld_mstmm_forces": (None, [_handle, c_void_p, c_void_p, c_void_p, c_void_p, c_void_p]),
    "ld_mstmm_reactions": (None, [_handle, c_void_p, c_void_p, c_void_p, c_void_p, c_void_p]),
    "ld_mstmm_loop_force": (None, [_handle, c_int, c_void_p]),
    "ld_mstmm_prescribe": (None, [_handle, c_int, c_int]),
    "ld_mstmm_energy": (ld_mstmm_energies, [_handle, c_void_p, c_void_p]),
    "ld_mstmm_momentum": (None, [_handle, c_void_p, c_void_p, c_void_p, c_void_p]),
    "ld_mstmm_locate": (ld_mstmm_point, [_handle, c_void_p, c_void_p, c_int, c_void_p]),
    "ld_mstmm_vibration": (c_int, [_handle, c_void_p, c_void_p, POINTER(ld_mstmm_mode), c_void_p,
                                   POINTER(c_int), _error]),
    "ld_mstmm_integrate": (c_int, [_handle, POINTER(ld_mstmm_settings), c_double, c_double,
                                   c_void_p, c_void_p, c_void_p, _error]),
}


# ---- where it is

def candidates() -> Iterator[str]:
    """Where the library is searched, in this order: where LAUNCHDYN_LIBRARY says, in the
    package's folder, in the build folder of the tree that holds it, in the installation that
    holds it, where the system finds it."""
    named = os.environ.get("LAUNCHDYN_LIBRARY")
    if named:
        yield named
        return
    name = f"liblaunchdyn.so.{INTERFACE}"
    package = Path(__file__).resolve().parent
    yield str(package / name)
    if (package.parent / "pyproject.toml").exists():
        yield str(package.parents[1] / "build" / name)
    multiarch = sysconfig.get_config_var("MULTIARCH") or ""
    for above in package.parents:
        if above.name in ("lib", "lib64"):
            yield str(above / multiarch / name)
            yield str(above / name)
    yield name


def check_version(number: int, text: str) -> None:
    """Refuses a library of another minor version: names of keys and numbers follow that."""
    major, minor, _ = (int(part) for part in VERSION.split("."))
    if number // 100 != 100 * major + minor:
        raise ImportError(f"this package requires launchdyn {major}.{minor}; found the library of "
                          f"{text}; LAUNCHDYN_LIBRARY sets another one")


def load() -> ctypes.CDLL:
    """Loads the first library that is there and declares its functions to ctypes."""
    tried = []
    for path in candidates():
        try:
            found = ctypes.CDLL(path)
        except OSError as reason:
            tried.append(f"  {path}: {reason}")
            continue
        for name, (result, arguments) in FUNCTIONS.items():
            try:
                function = getattr(found, name)
            except AttributeError:
                raise ImportError(f"{path} has no {name}: it is older than this package, or not "
                                  "launchdyn") from None
            function.restype, function.argtypes = result, arguments
        check_version(found.ld_version_number(), found.ld_version().decode())
        return found
    raise ImportError("the library of launchdyn was not found; LAUNCHDYN_LIBRARY sets its path. "
                      "Searched:\n" + "\n".join(tried))


library = load()
