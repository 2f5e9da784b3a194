"""The plots of clutter: how many each source has in each scan, and where they lie."""

from __future__ import annotations

import math

import numpy as np

from algorithms.compiled import kernel
from algorithms.rounding import floored
from algorithms.streams import uniform_pair
from scenarios.conversion import to_polar
from scenarios.plot_rows import put_polar, put_variance
from scenarios.streams import IN_SPACE, clutter_stream
from scenarios.world import BOX, VOLUME


@kernel
def clutter_numbers(clutter, measurement, streams):  # type: ignore[no-untyped-def]
    """Return the number of plots of each source in each scan of each trial, those of the batch left out.

    Returns
    -------
    numbers : int64 (trials, scans, sources)
    """
    scans, sources = len(measurement.time), len(clutter.fixed)
    numbers = np.empty((streams.trials, scans, sources), np.int64)
    for k in range(streams.trials):
        for scan in range(scans):
            for source in range(sources):
                first, end = clutter.offsets[source], clutter.offsets[source + 1]
                if first == end:
                    numbers[k, scan, source] = clutter.fixed[source, 0]
                    continue
                stream = clutter_stream(source, measurement.sensor[scan])
                trial = streams.first_trial + k
                chance, _ = uniform_pair(streams.seed, 0, measurement.number[scan], stream, trial)
                number = np.searchsorted(clutter.counts[first:end], chance, side="right")
                numbers[k, scan, source] = min(number, end - first - 1)
    return numbers


@kernel
def sort_batch(clutter, streams, trial, scans, begins, order, scan_of):  # type: ignore[no-untyped-def]
    """Sort the plots that sources have in the whole batch of a trial by their scans.

    Parameters
    ----------
    begins, order : int64 (sources, scans + 1) and (sources, plots), changed in place: the plots of source s
        in scan t are order[s, begins[s, t] : begins[s, t + 1]]
    scan_of : int64 (plots,), working space
    """
    for source in range(len(clutter.fixed)):
        number, stream = clutter.fixed[source, 1], clutter_stream(source, 0)
        begins[source] = 0
        for plot in range(number):
            chance, _ = uniform_pair(streams.seed, 2 * plot, 0, stream, trial)
            scan_of[plot] = min(floored(chance * scans), scans - 1)
            begins[source, scan_of[plot] + 1] += 1
        for scan in range(scans):
            begins[source, scan + 1] += begins[source, scan]
        # From behind, each scan's end is counted down to its begin, which is where it belongs.
        for plot in range(number - 1, -1, -1):
            end = scan_of[plot] + 1
            begins[source, end] -= 1
            order[source, begins[source, end]] = plot
        begins[source, :-1] = begins[source, 1:]
        begins[source, scans] = number


@kernel
def _sector_point(u, v, w, limits, sensor, is_volume, measured):  # type: ignore[no-untyped-def]
    """Write the polar coordinates of a random point of a sector."""
    near, far = limits[sensor, 0, 0], limits[sensor, 0, 1]
    axes = len(measured)
    if is_volume:
        power = float(axes)
        measured[0] = (near**power + u * (far**power - near**power)) ** (1.0 / power)
    else:
        measured[0] = near + u * (far - near)
    measured[1] = limits[sensor, 1, 0] + v * (limits[sensor, 1, 1] - limits[sensor, 1, 0])
    if axes > 2:
        low, high = limits[sensor, 2, 0], limits[sensor, 2, 1]
        if is_volume:
            measured[2] = math.asin(math.sin(low) + w * (math.sin(high) - math.sin(low)))
        else:
            measured[2] = low + w * (high - low)


@kernel
def _put_polar_plot(  # type: ignore[no-untyped-def]
    u, v, w, source, uniform, lower, size, sensor, limits, sigma, station, space, plots, covariance, row
):
    """Write a plot of clutter of a polar sensor, anywhere in a box or in its sector."""
    place, measured, ways = space
    if uniform[source] == BOX:
        place[0] = lower[source, 0] + u * size[source, 0]
        place[1] = lower[source, 1] + v * size[source, 1]
        if len(place) > 2:
            place[2] = lower[source, 2] + w * size[source, 2]
        to_polar(place, station, sensor, measured)
    else:
        _sector_point(u, v, w, limits, sensor, uniform[source] == VOLUME, measured)
    put_polar(measured, sigma, station, sensor, ways, plots, covariance, row)


@kernel
def put_clutter(  # type: ignore[no-untyped-def]
    trial, scan, source, number, batch, clutter, measurement, streams, space, plots, covariance, row
):
    """Write the plots that a source has in a scan, with their covariances where plots have them.

    Parameters
    ----------
    number : how many plots it has in this scan, those of the batch left out
    batch : int64 (k,), which of the plots of the batch fall into this scan; they come first
    clutter, measurement, streams : records
    space : place, measured and ways, float64 (d,), (d,) and (2d − 1, d), working space
    plots, covariance, row : float64 (n, d) and (n, d, d), changed in place from a row on

    Returns
    -------
    row : the next one
    """
    axes, seed = plots.shape[1], streams.seed
    sensor, own_scan = measurement.sensor[scan], measurement.number[scan]
    is_polar, limits = measurement.is_polar[sensor], measurement.limits
    sigma, station = measurement.sigma, measurement.station
    uniform, lower, size = clutter.uniform, clutter.lower, clutter.size
    of_batch, w, has_covariance = len(batch), 0.0, len(covariance) > 0
    for plot in range(of_batch + number):
        if plot < of_batch:
            block, drawn_in, stream = 2 * batch[plot] + 1, np.int64(0), clutter_stream(source, 0)
        else:
            block, drawn_in, stream = plot - of_batch + 1, own_scan, clutter_stream(source, sensor)
        u, v = uniform_pair(seed, block, drawn_in, stream, trial)
        if axes > 2:
            w, _ = uniform_pair(seed, block + IN_SPACE, drawn_in, stream, trial)
        if is_polar:
            _put_polar_plot(
                u, v, w, source, uniform, lower, size, sensor, limits, sigma, station, space, plots,
                covariance, row,
            )  # fmt: skip
        else:
            plots[row, 0] = lower[source, 0] + u * size[source, 0]
            plots[row, 1] = lower[source, 1] + v * size[source, 1]
            if axes > 2:
                plots[row, 2] = lower[source, 2] + w * size[source, 2]
            if has_covariance:
                put_variance(sigma, sensor, covariance, row)
        row += 1
    return row
