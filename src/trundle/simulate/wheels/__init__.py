"""Say where wheels are, and what road is under each."""
