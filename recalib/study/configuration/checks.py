"""What types cannot say of a configuration."""


def check(study):
    return []
