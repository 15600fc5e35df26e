"""The nominal robot: its kinematics, its workspace and the controller that uses them."""
