"""What makes of touch a training: motion as it was, metrics, scores and how they change with practice."""
