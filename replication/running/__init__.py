"""What the workflow's rules and jobs need: studies of a call, what jobs find around them."""
