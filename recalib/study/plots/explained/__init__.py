"""Pictures of ideas: they explain the method and show no result, but are drawn with its code."""
