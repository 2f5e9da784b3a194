"""How a measurement becomes a row of the plots, with its covariance.

The kernels take whole arrays and a row of each, no views: to make one costs more than a plot.
"""

from __future__ import annotations

from algorithms.compiled import kernel
from scenarios.conversion import convert


@kernel
def put_polar(measured, sigma, station, sensor, ways, plots, covariance, row):  # type: ignore[no-untyped-def]
    """Write what a polar measurement of a sensor is converted to as a plot, with its covariance.

    Parameters
    ----------
    measured : float64 (d,), range, azimuth and, in space, elevation
    sigma, station : float64 (sensors, d), noise and place of the sensors
    sensor : which of them it is
    ways : float64 (2d − 1, d), working space
    plots, covariance, row : float64 (n, d) and (n, d, d), changed in place at a row
    """
    convert(measured, sigma[sensor], ways, plots[row], covariance[row])
    for axis in range(len(measured)):
        plots[row, axis] += station[sensor, axis]


@kernel
def put_variance(sigma, sensor, covariance, row):  # type: ignore[no-untyped-def]
    """Write the covariance of a plot of a cartesian sensor, where the plots of others have one.

    Parameters
    ----------
    sigma, sensor, covariance, row : as `put_polar` takes them
    """
    if len(covariance) > 0:
        axes = covariance.shape[1]
        for axis in range(axes):
            for other in range(axes):
                covariance[row, axis, other] = 0.0
            covariance[row, axis, axis] = sigma[sensor, axis] ** 2
