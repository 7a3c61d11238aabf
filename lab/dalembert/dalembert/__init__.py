"""Mechanisms by d'Alembert's principle and high-precision differences, compared with hamel's results for the same
texts."""
