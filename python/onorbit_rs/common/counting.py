"""Numbers followed by a noun in singular or plural, for messages."""


def count(number: int, one: str, many: str) -> str:
    """Return a number with its noun, such as ``1 joint`` or ``2 joints``."""
    return f"{number} {one if number == 1 else many}"
