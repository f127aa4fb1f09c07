"""Degrees of the surface from the radians within: the number that somebody wrote, not the way it is kept."""

import math


def written_degrees(radians: float) -> float:
    """The shortest number of degrees that is `radians` to the last bit: 500, not 500.00000000000006.

    What is not finite stays as it is.
    """
    degrees = math.degrees(radians)
    if not math.isfinite(degrees):
        return degrees
    tried = [round(degrees, digits) for digits in range(18)]
    tried += [math.nextafter(degrees, -math.inf), math.nextafter(degrees, math.inf)]
    return next((number for number in tried if math.radians(number) == radians), degrees)
