"""What the charts agree on: neighbourhoods, heading axes, a compass, a metric map."""
