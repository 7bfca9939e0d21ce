"""What a run gives: measures, records, words.

`measures`, `first_contact`: restitution, capture, pull-off and so on from a motion. `conversion`: a
motion to a `Result`. `assessment`: which models hold. `result`, `result_data`: the results.
`record_layout`, `netcdf_record`, `read_record`, `results_folder`: files. `summary`, `impact_table`,
`verdict`, `shares`: words and tables. `surface_report`: a described surface in words.
`contact_window`: the stretch of time in which the first contact is shown.
`case_source`: what stands for a case: a name, a file, a record. `colours`: one colour for each
quantity.

A new measure is a field of `measures.Measures`, its unit and meaning in `record_layout`, and a
column in `sweeps.study.columns`.
"""
