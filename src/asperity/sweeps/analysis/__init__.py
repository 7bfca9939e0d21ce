"""Results of a study: tables for other programs, Pareto fronts, Sobol indices, views."""
