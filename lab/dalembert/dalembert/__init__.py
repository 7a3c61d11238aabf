"""Mechanisms by d'Alembert's principle and differences of many digits, beside what hamel says of the same texts."""
