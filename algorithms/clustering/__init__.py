"""Plot clustering: of the many detections of a target by a high-resolution radar, one plot.

A set of points of one scan is split until every part is as narrow as a target; points far from the
centre of their part are dropped as interference; the part gives one plot.
"""
