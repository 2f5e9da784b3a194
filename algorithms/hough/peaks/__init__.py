"""Peak extraction: from an accumulator to the cells that are tracks, one module an extraction.

Accumulators here are those of the voting kernels, with a sentinel column on each side, or the
weighted votes in the same shape. A chosen cell is written as (row, column, value), the column
counted without the sentinel. Rows are θ and columns are ρ; the thesis's matrices are turned.
"""
