"""Answer in frequency: for all waves of a road, and for all places of a floor."""
