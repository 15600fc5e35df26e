"""Files that are read whole or refused, and appear whole or not at all; quantities in them."""
