"""Case files: the schema, its reading and writing, and the physical quantities of a case.

`schema`: a case and the rules between its tables (`rules`, `limits`); one file a table: `bodies`,
`roughness`, `adhesion_tables`, `plasticity`, `gas`, `waves`, `viscoelasticity`, `run_tables`,
`publication`. `fields`: kinds of value; `key_labels`: every key in words.
`case_file`: text to case; `case_text`: case to text; `replacing`: a case with other values;
`problems`: what is wrong with a case, in one line. `asperities`: heights from numbers or files.
`resolve`: case to `asperity.inputs.Inputs`. `cases`: the built-in cases.

A new key is a field with its unit, meaning and example; form, template and help follow from it.
"""

from asperity.config.case_file import BUILTINS, FIRST, builtin, load, load_file, template
from asperity.config.run_tables import Output
from asperity.config.schema import Case

__all__ = ["BUILTINS", "FIRST", "Case", "Output", "builtin", "load", "load_file", "template"]
